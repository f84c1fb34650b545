"""Corrupt C files and certificates, and count those that are accepted all the same: the count must be zero.

``python -m tests.campaigns.certificates.mutations --c 2000 --certificates 1000`` runs the campaigns. A mutant is one
corrupted file. A corrupted C file is judged by its meaning alone: the certificate gets its new hash and a new seal, as
a forger would do, so that only the mathematics can refuse it. A tampered certificate is tried as it is, and again with
a new seal. A mutant that provably computes the same is no corruption: equality of operations decides this.
"""

import json
import re
from argparse import ArgumentParser
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from hashlib import sha256
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

from symrot.certificates import exact_check, recheck
from symrot.certificates.audit import audit, operations_of
from symrot.certificates.certificate import Data, KernelUnderTest, certificate_json, proven_statement
from symrot.certificates.readback.operations import Operations
from symrot.certificates.readback.readback import read_batch, read_kernel
from symrot.errors import CertificateError
from tests.campaigns.certificates.claims import is_weaker_or_equal, same_but_for_bounds
from tests.campaigns.certificates.same_bits import same_bits

__all__ = [
    "Campaign", "Files", "corrupt_c", "corrupted_c", "main", "printed_certificate", "tamper", "tampered_certificates",
]  # fmt: skip

PRINTED = Path(__file__).parents[3] / "generated" / "c"

Edit = tuple[str, str]  # what was done, the text after it
_FUNCTIONS = {"sin": "cos", "cos": "sin", "sqrt": "fabs", "fabs": "sqrt", "atan2": "copysign", "copysign": "atan2"}
_BODY = re.compile(r"^\{\n(.*?)^\}$", re.DOTALL | re.MULTILINE)
_LITERAL = re.compile(r"(?<![\w.])\d+\.\d*(?:e[-+]?\d+)?(?=f?\b)|(?<![\w.])\d+e[-+]?\d+(?=f?\b)")


def _bodies(text: str) -> list[tuple[int, int]]:
    return [match.span(1) for match in _BODY.finditer(text)]


def _one_of(pattern: str, text: str, random: Random) -> re.Match[str] | None:
    """Return a random match of a pattern inside a function; all matches are equally likely."""
    found = [m for start, end in _bodies(text) for m in re.compile(pattern).finditer(text, start, end)]
    return random.choice(found) if found else None


def _replaced(text: str, match: re.Match[str], new: str) -> str:
    return text[: match.start()] + new + text[match.end() :]


def _operator(text: str, random: Random) -> str | None:
    match = _one_of(r"(?<=[\w)\]]) ?[-+*/] ?(?=[\w(-])", text, random)
    if match is None:
        return None
    others = [mark for mark in "+-*/" if mark != match[0].strip()]
    return _replaced(text, match, match[0].replace(match[0].strip(), random.choice(others)))


def _sign(text: str, random: Random) -> str | None:
    match = _one_of(r"(?<== )(?=[\w(])|(?<=\()(?=[a-z]\w*[*+)])", text, random)
    return None if match is None else _replaced(text, match, "-")


def _operand(text: str, random: Random) -> str | None:
    spans = _bodies(text)
    start, end = random.choice(spans)
    names = sorted(set(re.findall(r"const (?:double|float) (\w+) =", text[start:end])))
    uses = [m for name in names for m in re.compile(rf"(?<![\w]){name}(?!\w| =|\()").finditer(text, start, end)]
    if len(names) < 2 or not uses:
        return None
    match = random.choice(uses)
    return _replaced(text, match, random.choice([name for name in names if name != match[0]]))


def _constant(text: str, random: Random) -> str | None:
    match = _one_of(_LITERAL.pattern, text, random)
    if match is None:
        return None
    value = float(match[0])
    new = random.choice((value * 2, value + 1, value / 2 or 0.5, -value or 1.0, value * (1 + 2.0**-20)))
    return _replaced(text, match, repr(float(new)))


def _last_digit(text: str, random: Random) -> str | None:
    """Change a coefficient by one unit in the last place, in a series if there is one."""
    from math import nextafter

    match = _one_of(r"(?<![\w.])\d\.\d{6,}(?:e[-+]?\d+)?(?=f?\b)", text, random)
    if match is None:
        return None
    if text[match.end() : match.end() + 1] == "f":
        return _replaced(text, match, f"{float(match[0]) * (1 + 2.0**-22):.9g}")
    return _replaced(text, match, repr(nextafter(float(match[0]), random.choice((0.0, 10.0)))))


def _function(text: str, random: Random) -> str | None:
    match = _one_of(r"\b(?:sin|cos|sqrt|fabs|atan2|copysign)(?=f?\()", text, random)
    return None if match is None else _replaced(text, match, _FUNCTIONS[match[0]])


def _index(text: str, random: Random) -> str | None:
    match = _one_of(r"(?<=\[)\d+(?=[]*])", text, random)
    others = [str(i) for i in range(9) if match is not None and str(i) != match[0]]
    return None if match is None else _replaced(text, match, random.choice(others))


def _dropped(text: str, random: Random) -> str | None:
    match = _one_of(r"(?<=[\w)\]]) [-+] [\w*.\[\]]+(?=[;)])", text, random)
    return None if match is None else _replaced(text, match, "")


def _statement(text: str, random: Random) -> str | None:
    match = _one_of(r"^ +\w+\[[^]]*\] = [^;]*;\n", text, random)
    return None if match is None else _replaced(text, match, random.choice(("", match[0] * 2)))


def _choice(text: str, random: Random) -> str | None:
    match = _one_of(r"\? ([^:;?]+) : ([^:;?]+);|(?<= )(?:>=|<|==)(?= [\w.]+ \?)", text, random)
    if match is None:
        return None
    if match[1]:
        return _replaced(text, match, f"? {match[2]} : {match[1]};")
    return _replaced(text, match, random.choice([mark for mark in (">=", "<", "==", ">", "<=") if mark != match[0]]))


def _comment(text: str, random: Random) -> str | None:
    """Hide the end of a statement in a comment or behind a spliced line."""
    match = _one_of(r"(?<=[\w)\]]) [-+] (?=[\w(])", text, random)
    if match is None:
        return None
    trick = random.choice((" /*{}*/", " /* {} */ /*/ */", "; //{}", "; //\\\n", " /*/{}*/"))
    end = text.index(";", match.end())
    return text[: match.start()] + trick.format(text[match.start() : end].replace("\n", " ")) + text[end:]


def _second(text: str, random: Random) -> str | None:
    """Add a second definition, before or after the first."""
    head = r"^(?:static inline )?(?:void|double|float) \w+\([^)]*\)\n"
    match = re.search(head + r"\{.*?^\}\n", text, re.DOTALL | re.MULTILINE)
    if match is None:
        return None
    other = match[0].replace("+", "-", 1) if "+" in match[0] else match[0]
    at = random.choice((match.start(), match.end()))
    return text[:at] + other + text[at:]


_MACROS = (
    "#define sin cos\n", "#define double float\n", "#pragma STDC FENV_ACCESS ON\n", "%:define cos sin\n",
    "#ifdef __FAST_MATH__\n#endif\n", '#include "other.h"\n', "??=define sin cos\n", "_Pragma(\"GCC optimize\")\n",
    "static inline double sin(double x)\n{\n    return x;\n}\n\n", "#define cos(x) \\\n    (1.0)\n", "#undef NAN\n",
    "#include <tgmath.h>\n", "double sin;\n", "#\tdefine sin cos\n", "/**/#define sin cos\n",
)  # fmt: skip


def _macro(text: str, random: Random) -> str | None:
    at = random.choice([m.start() for m in re.finditer(r"^(?:static |void |#include)", text, re.MULTILINE)])
    return text[:at] + random.choice(_MACROS) + text[at:]


def _type(text: str, random: Random) -> str | None:
    match = _one_of(r"\b(?:double|float)\b", text, random) if random.random() < 0.7 else None
    match = match or random.choice(list(re.finditer(r"\b(?:double|float)\b", text[text.index("#include") :])))
    shift = 0 if match.re.pattern != r"\b(?:double|float)\b" or match.string == text else text.index("#include")
    new = "float" if match[0] == "double" else "double"
    return text[: match.start() + shift] + new + text[match.end() + shift :]


EDITS: dict[str, Callable[[str, Random], str | None]] = {
    "operator": _operator, "sign": _sign, "operand": _operand, "constant": _constant, "last digit": _last_digit,
    "function": _function, "index": _index, "dropped term": _dropped, "statement": _statement, "choice": _choice,
    "comment": _comment, "second definition": _second, "macro": _macro, "type": _type,
}  # fmt: skip


def corrupt_c(text: str, random: Random) -> Edit:
    """Return one corruption of a C file, of a random kind among those that apply."""
    while True:
        kind = random.choice(list(EDITS))
        found = EDITS[kind](text, random)
        if found is not None and found != text:
            return kind, found


def _leaves(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[tuple[Any, ...], Any]]:
    if isinstance(value, dict | list):
        for key, each in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _leaves(each, (*path, key))
        if path:
            yield path, value
    else:
        yield path, value


def _altered(value: Any, random: Random) -> Any:
    """Return another value of the same kind, for a leaf, a list or an object."""
    if isinstance(value, bool) or value is None:
        return 1
    if isinstance(value, int | float):
        return value + random.choice((-1, 1, 10**30))
    if isinstance(value, str):
        changes = [value + "0", value[:-1], "", value.swapcase(), value + " + 1", f"-({value})", value * 2]
        digits = list(re.finditer(r"\d", value))
        if digits:
            at = random.choice(digits)
            changes += [value[: at.start()] + str((int(at[0]) + 1) % 10) + value[at.end() :]] * 4
        return random.choice([change for change in changes if change != value])
    if isinstance(value, list):
        kinds = [value[:-1], [*value, *value[-1:]], list(reversed(value)), []]
        return random.choice([kind for kind in kinds if kind != value] or [[1]])
    key = random.choice(list(value) or [""])
    return random.choice(({k: v for k, v in value.items() if k != key}, value | {"other": 1}, {}))


def tamper(data: Data, random: Random) -> tuple[str, Data]:
    """Return a certificate with one altered value (not the seal), and the name of the part that contains the value."""
    parts = [part for part in data if part != "seal" and data[part]]
    while True:
        part = random.choice(parts)
        path, value = random.choice(list(_leaves(data[part], (part,))))
        changed = json.loads(json.dumps(data))
        place = changed
        for key in path[:-1]:
            place = place[key]
        place[path[-1]] = _altered(value, random)
        if changed != data:
            return part, changed


def printed_certificate(name: str) -> str:
    """Return the certificate of a kernel, or of a scene's rates, as it is printed in ``generated/c``."""
    (path,) = (path for stem in (name, f"{name}_rates") for path in PRINTED.rglob(f"{stem}.cert.json"))
    return path.read_text(encoding="utf-8")


class Files:
    """One kernel in a folder: its texts, its certificate, and symrot's answer about the kernel."""

    def __init__(self, directory: Path, subject: KernelUnderTest, certificate: str) -> None:
        is_scene = any(name.startswith("../../") for name in subject.files)
        self.directory = directory / "c" / "scenes" if is_scene else directory / "c"
        self.subject, self.name, self.texts = subject, subject.name, subject.files
        self.said = proven_statement(subject)
        self.data: Data = json.loads(certificate)
        self.digests = _digests(self.source, self.data)
        self.path = self.directory / f"{self.name}.cert.json"
        self.directory.mkdir(parents=True, exist_ok=True)
        self.restore()

    @property
    def source(self) -> str:
        return self.texts[f"{self.name}.c"]

    @property
    def operations(self) -> tuple[Operations, Operations | None]:
        """Return the functions in double and in float, as they are read back."""
        double, *single = operations_of(self.data, self.source).values()
        return double, single[0] if single else None

    def same_bits(self, other: str, random: Random) -> bool:
        """Return whether another text of the C file computes the same bits when both are run."""
        named = {Path(file).name: text for file, text in self.texts.items()}
        return same_bits(named, self.name, other, self.data, random)

    def restore(self) -> None:
        """Write all files as they were."""
        for name, text in self.texts.items():
            path = (self.directory / name).resolve()
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        self.path.write_text(certificate_json(self.data), encoding="utf-8")

    def accepted(self) -> list[str]:
        """Return which checkers accept the files as they are: "recheck", "exact", "audit"."""
        found = []
        for judge, module, refusals in (("recheck", recheck, Exception), ("exact", exact_check, exact_check.REFUSALS)):
            try:
                module.check(self.path)
                found.append(judge)
            except refusals:
                continue
        try:
            audit(self.path, lambda data: self.said)
            found.append("audit")
        except CertificateError:
            pass
        return found


def _digests(text: str, data: Data) -> list[str]:
    """Return the operations of a C text's functions in comparable form, or nothing if the text cannot be read."""
    try:
        return [
            operations.digest()
            for name in data["readback"]
            for operations in (read_kernel(text, name), read_batch(text, f"{name}_batch"))
        ]
    except CertificateError:
        return []


class Campaign:
    """The results on mutants: per kind, how many were tried and how many compute the same; and the survivors, wrongly
    accepted.
    """

    def __init__(self) -> None:
        self.tried: Counter[str] = Counter()
        self.same: Counter[str] = Counter()
        self.words: Counter[str] = Counter()  # what recheck.py does not look at: refused by the audit alone
        self.proofs = 0  # those among them that the exact check, with which the audit begins, refuses: proofs of laws
        self.survivors: list[str] = []

    def lines(self, title: str, seconds: float) -> list[str]:
        kinds, alike = (
            ", ".join(f"{kind} {count}" for kind, count in sorted(counted.items()))
            for counted in (self.tried, self.same)
        )
        same = f"{self.same.total()} the same" + (f" ({alike})" if alike else "")
        said = f"{title}: {self.tried.total()} tried, {same}, {len(self.survivors)} accepted, {seconds:.0f} s"
        if self.words:
            said += f"; {self.words.total()} not for recheck.py to see, refused by the audit alone"
            said += f" ({self.proofs} in proofs of laws, by its exact check)"
        return [said, f"  {kinds}", *(f"  ACCEPTED {each}" for each in self.survivors)]


def corrupted_c(kernels: Sequence[Files], count: int, random: Random) -> Campaign:
    """Corrupt C files, correct their hash and seal the certificate anew; every checker has to refuse the result.

    A mutant with the operations of the original, in all functions, computes the same, rounding for rounding. So does a
    mutant that writes -x where only x^2 matters: the audit refuses it because its operations differ; ``recheck.py`` and
    the exact check accept it because its formulas are equal, and running both shows equal bits.
    """
    campaign = Campaign()
    for _ in range(count):
        files = random.choice(kernels)
        kind, text = corrupt_c(files.source, random)
        campaign.tried[kind] += 1
        if _digests(text, files.data) == files.digests:
            campaign.same[kind] += 1
            continue
        (files.directory / f"{files.name}.c").write_text(text, encoding="utf-8")
        digest = sha256(text.encode()).hexdigest()
        forged = files.data | {"files": files.data["files"] | {f"{files.name}.c": digest}}
        files.path.write_text(certificate_json(forged), encoding="utf-8")
        accepted = files.accepted()
        files.restore()
        if accepted and "audit" not in accepted and files.same_bits(text, random):
            campaign.same[kind] += 1
            continue
        campaign.survivors += [f"{who}: {files.name}, {kind}" for who in accepted]
    return campaign


def tampered_certificates(kernels: Sequence[Files], count: int, random: Random, sealed: bool) -> Campaign:
    """Alter one value of a certificate; with ``sealed``, seal it anew, as a forger would do.

    Without the new seal both checkers have to refuse everything. With it, the audit has to refuse everything except
    bounds on another box that are right for that box, since a certificate is what symrot prints, byte for byte.
    ``recheck.py`` and the exact check have to refuse every change of files, formulas, series or laws, judged by
    :mod:`tests.campaigns.certificates.claims`; ``recheck.py`` does not read proofs of laws (cases, steps, cofactors,
    witnesses).
    """
    campaign = Campaign()
    for _ in range(count):
        files = random.choice(kernels)
        part, data = tamper(files.data, random)
        campaign.tried[part] += 1
        files.path.write_text(certificate_json(data) if sealed else json.dumps(data), encoding="utf-8")
        accepted = files.accepted()
        files.restore()
        if sealed and "audit" in accepted and same_but_for_bounds(files.data, data, *files.operations):
            campaign.same[part] += 1
            continue
        if sealed and accepted and "audit" not in accepted and is_weaker_or_equal(files.data, data):
            campaign.words[part] += 1
            campaign.proofs += "exact" not in accepted
            continue
        campaign.survivors += [f"{who}: {files.name}, {part}{', sealed anew' if sealed else ''}" for who in accepted]
    return campaign


SAMPLE = (
    "quaternion_dcm", "quaternion_of_dcm", "quaternion_product", "euler_zyx_body_rates", "euler_zxz_of_quaternion",
    "euler_extrinsic_xyz_dcm", "rotation_vector_body_jacobian", "rotation_vector_body_rates",
    "rotation_vector_of_quaternion", "mrp_shadow", "rodrigues_space_rates", "euler_equations_principal",
    "rigid_body_tensor", "torque_gravity", "torque_damping_quadratic", "inertia_cone", "inertia_parallel_axis",
    "heavy_top_loops", "gravity_gradient_satellite",
)  # fmt: skip


def main(argv: Sequence[str] | None = None) -> int:
    """Run the campaigns and print the survivors; exit with 1 if there are any."""
    from symrot.workshop.kernel_text import kernel_text

    parser = ArgumentParser(
        prog="python -m tests.campaigns.certificates.mutations", description="Corrupt kernels and certificates."
    )
    parser.add_argument("--c", type=int, default=2000, metavar="N", help="corrupted C files")
    parser.add_argument("--certificates", type=int, default=1000, metavar="N", help="tampered certificates")
    parser.add_argument("--objects", type=int, default=0, metavar="N", help="corrupted object files")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args(argv)
    random, survivors = Random(options.seed), 0
    with TemporaryDirectory(prefix="symrot-") as directory:
        kernels = []
        for name in SAMPLE:
            folder = Path(directory) / name
            folder.mkdir()
            kernels.append(Files(folder, kernel_text(name).under_test(), kernel_text(name).certificate()))
        for title, run in (
            ("corrupted C files", partial(corrupted_c, kernels, options.c, random)),
            ("tampered certificates", partial(tampered_certificates, kernels, options.certificates, random, False)),
            ("tampered, sealed anew", partial(tampered_certificates, kernels, options.certificates, random, True)),
        ):
            start = process_time()
            campaign = run()
            survivors += len(campaign.survivors)
            print("\n".join(campaign.lines(title, process_time() - start)), flush=True)
    if options.objects:
        from tests.campaigns.certificates.object_campaign import main as objects

        survivors += objects(["--every", "40", "--mutants", str(options.objects)])
    return 1 if survivors else 0


if __name__ == "__main__":
    raise SystemExit(main())
