"""The certificate of an emitted kernel: statements about its files, and their proofs, as JSON.

Two statements are proven here: the formulas obey their laws, such as "the norm is 1", and the C text computes the
formulas (the readback). The program ``recheck.py`` checks a certificate without symrot.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from sympy import Expr, Function, Symbol

from symrot.build import cache as proof_cache
from symrot.build.code_digest import code_digest, text_digest
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
    "KernelUnderTest",
    "certificate_json",
    "certificate_text",
    "intended_text",
    "proven_statement",
    "seal",
    "statement_of_name",
    "unproven_statement",
    "with_sections",
]

SCHEMA = "symrot.certificate/1"
Data = dict[str, Any]

TRUSTED = {
    "formulas and laws": "`symrot audit`, which proves them exactly, or recheck.py, which evaluates them at random "
    "points",
    "C text": "that the compiler implements C correctly: real numbers are rounded to nearest, as IEEE 754 says",
    "functions": "sin, cos, sqrt and others of <math.h> are, but for rounding, the functions of that name",
}


# Sections about rounding errors and object code are added on request. The same kernel has the same certificate, byte
# for byte, on every machine.
@dataclass(frozen=True)
class KernelUnderTest:
    """A kernel to certify: the formulas and laws that its description states, and the printed files."""

    name: str
    title: str
    description: Description
    inputs: tuple[Argument, ...]
    outputs: tuple[tuple[Argument, tuple[Expr, ...]], ...]
    named: tuple[tuple[Symbol, Expr], ...]
    laws: tuple[Law, ...]
    # path, relative to the certificate -> text of the file
    files: Mapping[str, str]
    # suffix of a C function's name -> type of its numbers, such as "f" -> "float"
    types: Mapping[str, str]
    parameters: Mapping[str, Expr] = field(
        default_factory=dict
    )  # symbol of an input -> the formula in physical constants for which the symbol stands

    @property
    def places(self) -> dict[str, tuple[str, str]]:
        """A map from each input component, such as ``"q[1]"``, to its symbol and unit."""
        return {place: (name, unit) for a in self.inputs for place, (name, unit, _) in a.places.items()}

    @property
    def formulas(self) -> dict[str, tuple[str, Expr]]:
        """A map from each output component, such as ``"dq[1]"``, to its symbol and formula."""
        return {
            place: (component[0], formula)
            for target, formulas in self.outputs
            for (place, component), formula in zip(target.places.items(), formulas, strict=True)
        }


def certificate_text(kernel: KernelUnderTest) -> str:
    """Return the text of a kernel's certificate, with proofs of the kernel's laws and of what its C text computes.

    The cache of compiled C also stores the proofs.

    Raises
    ------
    CertificateError
        If the C text does not compute the formulas, or a law does not follow from them.
    """
    statement = unproven_statement(kernel)
    key_content = [
        statement,
        [[law.text, str(law.vanishing), str(law.relations)] for law in kernel.laws],
        _prover_digest(),
    ]
    key = f"certificate {text_digest(json.dumps(key_content))}"
    # proofs are stored for the same statements and the same version of the provers
    proofs = proof_cache.fetch(key)
    if proofs is None:
        proofs = json.dumps(_proven(kernel))
        proof_cache.store(key, proofs)
    return certificate_json(statement | json.loads(proofs))


PROVERS = (
    "certificate", "laws/equality", "laws/fractions", "laws/law_proof", "laws/laws", "readback/c_functions",
    "readback/intended_constants", "readback/operations", "readback/readback", "../kernels/removable",
)  # fmt: skip
"""The modules that find proofs; cached proofs are valid only while none of them changes."""


@cache
def _prover_digest() -> str:
    """Return the SHA-256 of the source files that make the proofs, without docstrings and comments."""
    here = Path(__file__).parent
    # part of the key of each proof in the cache, so that a proof by other sources is not used
    return code_digest((here / f"{name}.py").read_text(encoding="utf-8") for name in PROVERS)


def unproven_statement(kernel: KernelUnderTest) -> Data:
    """Return the parts of a kernel's certificate that need no proof, such as formulas and hashes of the files."""
    description = kernel.description
    return {
        "schema": SCHEMA,
        "kernel": kernel.name,
        "title": kernel.title,
        "regenerate": description.command,
        "convention": description.convention,
        "domain": description.domain,
        "derivation": description.derivation,
        "files": {path: text_digest(text) for path, text in kernel.files.items()},
        "inputs": [[place, *described] for place, described in kernel.places.items()],
        "spec": {
            "parameters": {symbol: str(value) for symbol, value in kernel.parameters.items()},
            "named": [[str(symbol), str(value)] for symbol, value in kernel.named],
            "formulas": [[place, symbol, str(formula)] for place, (symbol, formula) in kernel.formulas.items()],
            "functions": _functions([*(value for _, value in kernel.named), *(f for _, f in kernel.formulas.values())]),
        },
        **statement_of_name(kernel.name),
    }


def statement_of_name(name: str) -> Data:
    """Return the parts of a certificate that need only the kernel's name: Coq theorem, compiler flags, assumptions."""
    return {"coq": coq_section(name), "flags": flags_section(), "trusted": TRUSTED}


def _functions(formulas: Sequence[Expr]) -> list[list[str]]:
    """Return pairs (name, definition) of the functions in the formulas that are 0/0 at a point, such as sin(x)/x."""
    x, y = (Symbol(name, real=True) for name in "xy")
    names = {type(call).__name__ for formula in formulas for call in formula.atoms(Function)}
    texts = {}
    for safe in FUNCTIONS_WITH_LIMIT:
        limit, formula = (
            each.xreplace(dict(zip(safe.arguments, (x, y), strict=False))) for each in (safe.limit, safe.formula)
        )
        texts[safe.name] = f"x == 0 ? {limit} : {formula}"
    texts |= {name: str(each.formula(x)) for name, each in REMOVABLE.items()}
    return [[name, text] for name, text in texts.items() if name in names]


def proven_statement(kernel: KernelUnderTest) -> Data:
    """Return the content of a kernel's certificate, with all proofs, but without the entry ``"seal"``, a checksum.

    CertificateError is raised if a proof fails.
    """
    # an audit compares the data with a certificate's file; they have no optional sections (bounds, object code)
    return {key: value for key, value in json.loads(certificate_text(kernel)).items() if key != "seal"}


def _proven(kernel: KernelUnderTest) -> Data:
    """Return the sections of a kernel's certificate that hold proofs: ``laws`` and ``readback``.

    ``laws`` has a proof of each law that the formulas obey; ``readback`` has, for each C function, the proof that it
    computes the formulas. CertificateError is raised if a proof fails.
    """
    known = {str(symbol): value for symbol, value in kernel.named} | dict(kernel.formulas.values())
    return {
        "laws": [_law(prove_law(kernel.name, law, known)) for law in kernel.laws],
        "readback": {
            f"symrot_{kernel.name}{suffix}": _readback(kernel, suffix, real) for suffix, real in kernel.types.items()
        },
    }


def _law(proof: LawProof) -> Data:
    return {
        "law": proof.text, "vanishing": list(proof.vanishing), "given": list(proof.hypothesis_names),
        "witness": dict(proof.witness), "cases": [_case(case) for case in proof.cases],
    }  # fmt: skip


def _case(proof: CaseProof) -> Data:
    return {
        "case": [list(choice) for choice in proof.case],
        "steps": _as_lists(proof.steps),
        "relations": list(proof.relations),
        "entries": [[entry.factor, _as_lists(entry.cofactors)] for entry in proof.entries],
    }


def _as_lists(value: Any) -> Any:
    return [_as_lists(each) for each in value] if isinstance(value, tuple) else value


def _readback(kernel: KernelUnderTest, suffix: str, real: str) -> Data:
    """Return the ``readback`` entry of one C function: its operations, and the proof that they give the formulas.

    ``suffix`` and ``real`` are ``""`` and ``"double"``, or ``"f"`` and ``"float"``.
    """
    name, file = f"symrot_{kernel.name}{suffix}", f"{kernel.name}.c"
    text = kernel.files[file]
    one, batch = read_kernel(text, name, file), read_batch(text, f"{name}_batch", file)
    if one.digest() != batch.digest():
        raise CertificateError(
            f"{file}: expected {name} and {name}_batch to perform the same operations, got different ones"
        )
    symbols = {place: symbol for place, (symbol, _) in kernel.places.items()}
    proof = prove_equal(
        one, symbols, {place: f for place, (_, f) in kernel.formulas.items()}, kernel.named, kernel.parameters
    )
    return {
        "type": real,
        "operations": one.counts(),
        "digest": one.digest(),
        "constants": [[str(each.written), intended_text(each)] for each in proof.rounded],
        "series": _series(proof),
    }


def intended_text(constant: IntendedConstant) -> str:
    """Return the exact number for which a rounded constant of the C text stands: ``"1/3"`` or ``"1/2*pi"``."""
    return f"{constant.fraction}*pi" if constant.times_pi else str(constant.fraction)


def _series(proof: Equality) -> list[list[Any]]:
    truncations = {each.function: each for each in proof.truncations}
    return [
        [
            each.function,
            str(each.split),
            list(map(str, REMOVABLE[each.function].taylor(each.terms))),
            str(each.relative),
        ]
        for each in (truncations[name] for name in REMOVABLE if name in truncations)
    ]


def seal(data: Data) -> str:
    """Return the seal of a certificate: the SHA-256 of all its content except the seal itself."""
    bare = {key: value for key, value in data.items() if key != "seal"}
    return text_digest(json.dumps(bare, sort_keys=True, separators=(",", ":")))


OPTIONAL_SECTIONS: dict[str, Callable[[Data, Any], bool]] = {  # section -> is it about the C text of a certificate?
    "rounding": lambda data, section: (
        [part["operations_sha256"] for part in section["precisions"]]
        == [function["digest"] for function in data["readback"].values()]
    ),
    "objects": lambda data, section: data["files"].get(section["source"]["name"]) == section["source"]["sha256"],
}


def with_sections(text: str, sections: Mapping[str, Any]) -> str:
    """Return the certificate ``text`` with optional sections, such as ``"rounding"``, added from ``sections``.

    A section that is malformed, or not about the C text of this certificate but about an earlier version, is left out.
    """
    data = json.loads(text)
    for name, is_about in OPTIONAL_SECTIONS.items():
        try:
            if sections.get(name) is not None and is_about(data, sections[name]):
                data[name] = sections[name]
        except (KeyError, TypeError, AttributeError):
            continue
    return certificate_json(data)


def certificate_json(data: Data) -> str:
    """Return a certificate as JSON text; its last entry is the seal, a SHA-256 of all the other entries."""
    # a seal in ``data`` is ignored and computed again
    sealed = {key: value for key, value in data.items() if key != "seal"}
    return _layout(sealed | {"seal": seal(sealed)}) + "\n"


WIDTH = 118


def _layout(value: Any, indent: int = 0, key: str = "") -> str:
    """Return a value as JSON text, in which an object or list that fits on one line is written on one line.

    ``indent`` blanks come before the lines; ``key``, the name of the value, takes room on the first line.
    """
    flat = json.dumps(value, ensure_ascii=False)
    if len(flat) + indent + len(key) <= WIDTH or not isinstance(value, (dict, list)) or not value:
        return flat
    space = " " * (indent + 1)
    if isinstance(value, dict):
        inner = [f"{json.dumps(k)}: {_layout(v, indent + 1, k)}" for k, v in value.items()]
        return "{\n" + ",\n".join(f"{space}{each}" for each in inner) + "\n" + " " * indent + "}"
    inner = [_layout(each, indent + 1) for each in value]
    return "[\n" + ",\n".join(f"{space}{each}" for each in inner) + "\n" + " " * indent + "]"
