"""The certificate of an emitted kernel: what was proven of its text, as JSON that can be re-checked without symrot.

Links 1 (laws of the formulas) and 3 (C text = formulas) are proven here, from the texts as they are printed; the other
links are filled in by their rooms. Same kernel, same bytes, on every machine.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from sympy import Expr, Function, Symbol

from symrot.build import cache as library
from symrot.certificates.coq.library import coq_section
from symrot.certificates.flags import flags_section
from symrot.certificates.laws.equality import FUNCTIONS_WITH_LIMIT, Equality, prove_equal
from symrot.certificates.laws.law_proof import CaseProof
from symrot.certificates.laws.laws import LawProof, prove_law
from symrot.certificates.readback.intended_constants import IntendedConstant
from symrot.certificates.readback.readback import read_batch, read_kernel
from symrot.codegen.printing.banner import Description
from symrot.errors import CertificateError
from symrot.formula.program import Argument
from symrot.kernels.definition import Law
from symrot.kernels.removable import REMOVABLE

__all__ = [
    "SCHEMA",
    "Data",
    "Subject",
    "certificate_text",
    "printed",
    "said_of",
    "seal",
    "shown",
    "statement",
    "with_slots",
]

SCHEMA = "symrot.certificate/1"
Data = dict[str, Any]

TRUSTED = {
    "formulas and laws": "`symrot audit`, which proves them exactly, or recheck.py, which evaluates them at random "
    "points",
    "C text": "that the compiler gives C its meaning: real numbers are rounded as IEEE 754 says, to nearest",
    "functions": "sin, cos, sqrt and others of <math.h> are, but for rounding, the functions of that name",
}


@dataclass(frozen=True)
class Subject:
    """A kernel to certify: what it is said to compute, and the texts that were printed of it.

    ``files`` maps paths, as seen from the certificate, to texts; ``types`` maps the suffix of a function to its type.
    """

    name: str
    title: str
    description: Description
    inputs: tuple[Argument, ...]
    outputs: tuple[tuple[Argument, tuple[Expr, ...]], ...]
    named: tuple[tuple[Symbol, Expr], ...]
    laws: tuple[Law, ...]
    files: Mapping[str, str]
    types: Mapping[str, str]
    parameters: Mapping[str, Expr] = field(default_factory=dict)  # inputs that stand for a formula in constants

    @property
    def places(self) -> dict[str, tuple[str, str]]:
        """Return place of an input -> symbol, unit."""
        return {place: (name, unit) for a in self.inputs for place, (name, unit, _) in _places(a)}

    @property
    def formulas(self) -> dict[str, tuple[str, Expr]]:
        """Return place of an output -> symbol, formula."""
        return {
            place: (component[0], formula)
            for target, formulas in self.outputs
            for (place, component), formula in zip(_places(target), formulas, strict=True)
        }


def _places(argument: Argument) -> list[tuple[str, tuple[str, str, str]]]:
    if argument.is_scalar:
        return [(argument.name, argument.components[0])]
    return [(f"{argument.name}[{i}]", component) for i, component in enumerate(argument.components)]


def certificate_text(subject: Subject) -> str:
    """Return the certificate of a kernel, printed; every claim in it is proven, now or when it was last asked for.

    Proofs are kept in the cache by what they are about and by the programs that found them.

    Raises
    ------
    CertificateError
        If a text is not its formulas, or a law does not follow.
    """
    stated = statement(subject)
    about = [stated, [[law.text, str(law.vanishing), str(law.relations)] for law in subject.laws], _method()]
    key = f"certificate {sha256(json.dumps(about).encode()).hexdigest()}"
    kept = library.fetch(key)
    if kept is None:
        kept = json.dumps(_proven(subject))
        library.store(key, kept)
    return printed(stated | json.loads(kept))


PROVERS = (
    "certificate", "laws/equality", "laws/fractions", "laws/law_proof", "laws/laws", "readback/c_functions",
    "readback/intended_constants", "readback/operations", "readback/readback", "../kernels/removable",
)  # fmt: skip
"""The programs that find proofs: another one of them, other proofs."""


@cache
def _method() -> str:
    """Return the SHA-256 of the programs that prove."""
    here = Path(__file__).parent
    return sha256(b"".join((here / f"{name}.py").read_bytes() for name in PROVERS)).hexdigest()


def statement(subject: Subject) -> Data:
    """Return what a certificate says without proof: what the kernel is, what its files are, what is assumed."""
    description = subject.description
    return {
        "schema": SCHEMA,
        "kernel": subject.name,
        "title": subject.title,
        "regenerate": description.command,
        "convention": description.convention,
        "domain": description.domain,
        "derivation": description.derivation,
        "files": {path: sha256(text.encode()).hexdigest() for path, text in subject.files.items()},
        "inputs": [[place, *described] for place, described in subject.places.items()],
        "spec": {
            "parameters": {symbol: str(value) for symbol, value in subject.parameters.items()},
            "named": [[str(symbol), str(value)] for symbol, value in subject.named],
            "formulas": [[place, symbol, str(formula)] for place, (symbol, formula) in subject.formulas.items()],
            "functions": _functions(
                [*(value for _, value in subject.named), *(f for _, f in subject.formulas.values())]
            ),
        },
        "coq": coq_section(subject.name),
        "flags": flags_section(),
        "trusted": TRUSTED,
    }


def _functions(formulas: Sequence[Expr]) -> list[list[str]]:
    """Return what the functions with a removable singularity are that formulas call, of x, or x and y."""
    x, y = (Symbol(name, real=True) for name in "xy")
    found = {type(call).__name__ for formula in formulas for call in formula.atoms(Function)}
    texts = {}
    for safe in FUNCTIONS_WITH_LIMIT:
        limit, formula = (
            each.xreplace(dict(zip(safe.arguments, (x, y), strict=False))) for each in (safe.limit, safe.formula)
        )
        texts[safe.name] = f"x == 0 ? {limit} : {formula}"
    texts |= {name: str(each.formula(x)) for name, each in REMOVABLE.items()}
    return [[name, text] for name, text in texts.items() if name in found]


def said_of(subject: Subject) -> Data:
    """Return the certificate of a kernel as symrot proves it, without what is filled in on request, and the seal."""
    return {key: value for key, value in json.loads(certificate_text(subject)).items() if key != "seal"}


def _proven(subject: Subject) -> Data:
    """Return what is proven: link 1, laws of the formulas, and link 3, that the C text is the formulas."""
    known = {str(symbol): value for symbol, value in subject.named} | dict(subject.formulas.values())
    return {
        "laws": [_law(prove_law(subject.name, law, known)) for law in subject.laws],
        "readback": {
            f"{subject.name}{suffix}": _readback(subject, suffix, real) for suffix, real in subject.types.items()
        },
    }


def _law(found: LawProof) -> Data:
    return {
        "law": found.text, "vanishing": list(found.vanishing), "given": list(found.hypothesis_names),
        "witness": dict(found.witness), "cases": [_case(case) for case in found.cases],
    }  # fmt: skip


def _case(found: CaseProof) -> Data:
    return {
        "case": [list(choice) for choice in found.case],
        "steps": _plain(found.steps),
        "relations": list(found.relations),
        "entries": [[entry.factor, _plain(entry.cofactors)] for entry in found.entries],
    }


def _plain(value: Any) -> Any:
    return [_plain(each) for each in value] if isinstance(value, tuple) else value


def _readback(subject: Subject, suffix: str, real: str) -> Data:
    name, file = f"{subject.name}{suffix}", f"{subject.name}.c"
    text = subject.files[file]
    one, batch = read_kernel(text, name, file), read_batch(text, f"{name}_batch", file)
    if one.digest() != batch.digest():
        raise CertificateError(f"{file}: expected {name} and {name}_batch to compute the same, and they do not")
    symbols = {place: symbol for place, (symbol, _) in subject.places.items()}
    proof = prove_equal(
        one, symbols, {place: f for place, (_, f) in subject.formulas.items()}, subject.named, subject.parameters
    )
    return {
        "type": real,
        "operations": one.counts(),
        "digest": one.digest(),
        "constants": [[str(each.written), shown(each)] for each in proof.rounded],
        "series": _series(proof),
    }


def shown(meant: IntendedConstant) -> str:
    """Return what a constant stands for, as text."""
    return f"{meant.fraction}*pi" if meant.times_pi else str(meant.fraction)


def _series(proof: Equality) -> list[list[Any]]:
    found = {each.function: each for each in proof.truncations}
    return [
        [
            each.function,
            str(each.split),
            list(map(str, REMOVABLE[each.function].taylor(each.terms))),
            str(each.relative),
        ]
        for each in found.values()
    ]


def seal(data: Data) -> str:
    """Return the SHA-256 of a certificate without its seal."""
    bare = {key: value for key, value in data.items() if key != "seal"}
    return sha256(json.dumps(bare, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


SLOTS: dict[str, Callable[[Data, Any], bool]] = {  # what other rooms fill in: whether it is about this certificate
    "rounding": lambda data, found: (
        [part["operations_sha256"] for part in found["precisions"]]
        == [function["digest"] for function in data["readback"].values()]
    ),
    "objects": lambda data, found: data["files"].get(found["source"]["name"]) == found["source"]["sha256"],
}


def with_slots(text: str, slots: Mapping[str, Any]) -> str:
    """Return a certificate with bounds of rounding errors (``rounding``) and verdicts on object code (``objects``).

    Those are found on request, and kept while the kernel is what they are about: others are left out.
    """
    data = json.loads(text)
    for name, is_about in SLOTS.items():
        try:
            if slots.get(name) is not None and is_about(data, slots[name]):
                data[name] = slots[name]
        except (KeyError, TypeError, AttributeError):
            continue
    return printed(data)


def printed(data: Data) -> str:
    """Return a certificate as text, its seal at the end."""
    sealed = {key: value for key, value in data.items() if key != "seal"}
    return _layout(sealed | {"seal": seal(sealed)}) + "\n"


WIDTH = 118


def _layout(value: Any, indent: int = 0, key: str = "") -> str:
    """Return JSON with everything on one line that fits on it."""
    flat = json.dumps(value, ensure_ascii=False)
    if len(flat) + indent + len(key) <= WIDTH or not isinstance(value, (dict, list)) or not value:
        return flat
    space = " " * (indent + 1)
    if isinstance(value, dict):
        inner = [f"{json.dumps(k)}: {_layout(v, indent + 1, k)}" for k, v in value.items()]
        return "{\n" + ",\n".join(f"{space}{each}" for each in inner) + "\n" + " " * indent + "}"
    inner = [_layout(each, indent + 1) for each in value]
    return "[\n" + ",\n".join(f"{space}{each}" for each in inner) + "\n" + " " * indent + "]"
