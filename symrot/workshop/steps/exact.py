"""One time step of a motion in elliptic functions as C99: the state after any dt, without heap or loop over time.

The C text contains the code with which symrot itself propagates the motion. Every call computes the constants of the
motion from the state, in numbers of 31 digits; the cost does not depend on dt.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

from symrot.build.code_digest import text_digest
from symrot.certificates.certificate import Data, certificate_json
from symrot.certificates.exact_step.bounds import free_body_bounds
from symrot.certificates.exact_step.box import TINY
from symrot.certificates.exact_step.law import STATES as CHECKED
from symrot.certificates.exact_step.law import law_section
from symrot.certificates.step_certificate import SCHEMA, trusted
from symrot.closed_form.build import joined
from symrot.closed_form.registry import exact_form
from symrot.codegen.printing.c_function import DOUBLE, FLOAT, Real
from symrot.codegen.printing.parameters_header import parameters_file
from symrot.codegen.steady_rotations import STATES
from symrot.errors import InputError
from symrot.formula.tree import text as formula_text
from symrot.planning.plan import make_plan
from symrot.scene.scene import Scene
from symrot.workshop.kernel_text import Bounds, scene_kernel_name
from symrot.workshop.steps.files import StepFiles, constant_table
from symrot.workshop.steps.whole_state import WholeState

__all__ = ["ExactStepText", "plain_content"]

SPARE = 1 + 2e-6  # a stated bound is the computed bound times this factor, because sine differs between machines
BOXED = ("omega_1", "omega_2", "omega_3", "dt")
METHOD = "closed form of the motion, elliptic functions"
MEANING = (
    "for each state after one step from inputs in the box: |computed - exact motion| <= rounding + truncation, with "
    "the same floating-point initial state, step size and parameters, for the function of doubles; the exact motion "
    f"starts with the quaternion divided by its norm, and components of omega are 0 or at least {TINY:g} of the "
    "largest in the box"
)
SHARES = (Fraction(1, 16), Fraction(-3, 2), Fraction(5))  # sizes of the test vectors, in units of 1/|omega|
Motions = Callable[[Sequence[Fraction], Sequence[Fraction]], Any]


# The parameters p are those of the closed form: moments of inertia, and pull (weight times the distance of the centre
# of mass, in N m).
class _Form(NamedTuple):
    """What the C text of a time step contains for one kind of closed form: the free body or the heavy top."""

    library: str
    title: str
    derivation: str
    # (name, unit and meaning, value) of each number in p
    parameters: tuple[tuple[str, str, Fraction], ...]
    # definitions of constants, in C
    tables: tuple[str, ...]
    # arguments of the C function that prepares a motion
    arguments: tuple[str, ...]
    # indices of the body axes that the closed form calls e1, e2, e3
    named: tuple[int, int, int]
    # returns the motion for an initial omega and quaternion, and for parameters that are doubles
    motion: Motions


def _form(scene: Scene) -> _Form:
    known = exact_form(scene)
    if known is None or known.library not in _FORMS:
        raise InputError(
            f"{scene.name}: expected a free body, symmetric heavy top or symmetric gyrostat for the step 'exact', "
            "got a scene without such a closed form; use the step 'rk4', 'taylor' or 'dop853'"
        )
    if not scene.body.principal.given_axes:
        raise InputError(
            f"{scene.name}: expected a body given along its principal axes for the step 'exact', got products of "
            "inertia; use the step 'rk4', 'taylor' or 'dop853'"
        )
    return _FORMS[known.library](scene, known.derivation)


def _rounded(value: Fraction) -> Fraction:
    """Return, as a fraction, the double that is nearest to ``value``: the C function receives doubles.

    For 1/10 the result is 3602879701896397/36028797018963968.
    """
    return Fraction(float(value))


def _moments(scene: Scene) -> list[Fraction]:
    return [scene.body.inertia[i][i] for i in range(3)]


def _free_body(scene: Scene, derivation: str) -> _Form:
    from symrot.closed_form.free_body.motion import motion

    moments = _moments(scene)
    parameters = tuple((name, "kg m^2, principal moment", x) for name, x in zip("ABC", moments, strict=True))
    rounded = [_rounded(x) for x in moments]
    return _Form(
        "free_body", "free body", derivation, parameters, (), ("moments", "rates", "attitude", "0", "0"), (0, 1, 2),
        lambda omega, q: motion(rounded, omega, q),
    )  # fmt: skip


def _heavy_top(scene: Scene, derivation: str) -> _Form:
    from symrot.closed_form.heavy_top.motion import Frame, motion

    torque, moments = scene.torques[0], _moments(scene)
    center, down = torque.vector("center_of_mass"), torque.vector("direction")
    axis = next(i for i in range(3) if center[i])
    pull, sign = torque.number("weight") * abs(center[axis]), 1 if center[axis] > 0 else -1
    frame = Frame(axis, [-sign * x for x in down])
    tables = [_table("space", frame.space)]
    tables += [_table("body_axes", frame.axes)] if frame.axes else []
    for name, quaternion in (("before", frame.before), ("after", frame.after)):
        tables += [_table(name, [float(x) for x in quaternion])] if quaternion else []
    rounded = [_rounded(x) for x in moments]
    unit = [Fraction(sign * int(i == axis)) for i in range(3)]
    return _Form(
        "heavy_top", "symmetric heavy top", derivation,
        (("A", "kg m^2, moment across the axis, about the fixed point", moments[axis - 1]),
         ("C", "kg m^2, moment about the axis", moments[axis]),
         ("pull", "N m, weight times the distance of the centre of mass", pull)),
        tuple(tables), ("moments", "moments + 4", "rates", "attitude", "space", "body_axes" if frame.axes else "0"),
        (frame.named[0], frame.named[1], frame.named[2]),
        lambda omega, q: motion(rounded, _rounded(pull), unit, omega, q, down),
    )  # fmt: skip


_FORMS: Mapping[str, Callable[[Scene, str], _Form]] = {
    "free_body": _free_body, "heavy_top": _heavy_top,
}  # fmt: skip


def plain_content(content: Any) -> Any:
    """Return the content of a scene as data for JSON, in which decimals are texts, such as ``"0.1"``."""
    if isinstance(content, Mapping):
        return {str(key): plain_content(value) for key, value in content.items()}
    if isinstance(content, list | tuple):
        return [plain_content(each) for each in content]
    return content if isinstance(content, str | int | float | bool | None) else str(content)


def _table(name: str, values: Sequence[float]) -> str:
    return f"    {constant_table(f'{name}[]', list(values))}"


class ExactStepText(StepFiles):
    """The C text of one step of a motion in closed form, with a header, the parameters of the scene and a test.

    Parameters
    ----------
    scene : Scene
        A free body or a symmetric heavy top, given along its principal axes; InputError is raised for other scenes.
    """

    def __init__(self, scene: Scene) -> None:
        make_plan(scene)  # refuses tables and switches with their own sentences
        self.scene, self.form = scene, _form(scene)
        self.name = f"{scene_kernel_name(scene.name).removesuffix('_rates')}_exact_step"

    @cached_property
    def _source_and_header(self) -> tuple[str, str]:
        return self._source, self._header

    @property
    def _parameters(self) -> list[tuple[str, float]]:
        return [(name, float(value)) for name, _, value in self.form.parameters]

    def _printed(self, target: str) -> str:
        raise InputError(f"step: expected the target 'c' for the step 'exact', got {target}")

    def certificate(self, bounds: Bounds | None = None) -> str:
        """Return the text of the certificate, without bounds of errors; ``bounds`` is not used.

        CertificateError is raised if the C text violates the equations of motion.
        """
        rates, source = WholeState(self.scene), self.c()[0]
        exact, p = rates.exact_parameters, [value for _, _, value in self.form.parameters]
        laws = {
            f"symrot_{self.name}{suffix}": law_section(
                source, f"symrot_{self.name}{suffix}", rates.program, exact, p, self._rate, count
            )
            for suffix, count in (("", CHECKED), ("f", 1))
        }
        return certificate_json(self.statement | {"formula": laws, "trusted": trusted("exact", False, elliptic=True)})

    def bounds(self, box: Mapping[str, tuple[Fraction, Fraction]]) -> Data:
        """Return the section ``bounds`` of the certificate: rounding and truncation on a box of omega and dt.

        Raises
        ------
        InputError
            For a heavy top, a box without a range of omega or dt, or a box on which no bounds are known.
        """
        if self.form.library != "free_body":
            raise InputError(
                f"--box: expected no ranges for the exact step of {self.scene.name}, because symrot does not bound the "
                "errors of the exact step of a heavy top; use --step taylor --order 16 instead, whose result is close "
                "to the exact one"
            )
        if set(box) != set(BOXED):
            ranges = " ".join(f"--box {name}=LOW:HIGH" for name in BOXED)
            raise InputError(f"{self.name}: expected {ranges}, got {', '.join(box) or 'none'}")
        moments = [float(value) for _, _, value in self.form.parameters]
        rounding, truncation = free_body_bounds(self.c()[0], f"symrot_{self.name}", moments, box)
        return {
            "meaning": MEANING,
            "box": {name: [float(end).hex() for end in box[name]] for name in BOXED},
            "rounding": {name: (x * SPARE).hex() for name, x in zip(STATES, rounding, strict=True)},
            "truncation": {name: (x * SPARE).hex() for name, x in zip(STATES, truncation, strict=True)},
        }

    @property
    def statement(self) -> Data:
        """The part of the certificate that says which step of which scene it is about."""
        rates = WholeState(self.scene)
        return {
            "schema": SCHEMA, "kernel": self.name,
            "title": f"one time step of the scene {self.scene.name!r}, a {self.form.title}",
            "regenerate": f"symrot emit {self.scene.name} --step exact --target c", "method": METHOD,
            "step": {"method": "exact", "form": self.form.library},
            "scene": {"name": self.scene.name, "content": plain_content(self.scene.to_dict())},
            "parameters": [[name, meaning, str(value)] for name, meaning, value in self.form.parameters],
            "rates": {
                "constants": [[name, str(value)] for name, value in rates.exact_parameters.items()],
                "temporaries": [[name, formula_text(node)] for name, node in rates.program.temporaries],
                "formulas": [[name, formula_text(node)] for name, node in rates.program.outputs],
            },
            "files": {path: text_digest(text) for path, text in self.c_files().items()},
        }  # fmt: skip

    @property
    def _rate(self) -> Fraction:
        """The size of the angular velocities at which the certificate checks the equations, a power of two, rad/s.

        For a heavy top it is about sqrt(P/A): P, the parameter "pull", is the weight times the distance of the centre
        of mass, and A the moment of inertia across the axis. At this rate, both weight and rotation matter.
        """
        names = [name for name, *_ in self.form.parameters]
        if "pull" not in names:
            return Fraction(1)
        values = dict(zip(names, (value for _, _, value in self.form.parameters), strict=True))
        exponent = (int(values["pull"] / values["A"] * 2**64).bit_length() - 64) // 2
        return Fraction(2) ** exponent

    def _declaration(self, real: Real) -> str:
        count, c = len(self.form.parameters), real.type
        return f"int symrot_{self.name}{real.suffix}({c} t, const {c} x[7], const {c} p[{count}], {c} dt, {c} next[7])"

    @property
    def _banner(self) -> list[str]:
        return [
            "/*",
            f" * {self.name}: one exact time step of the scene {self.scene.name!r}, a {self.form.title}.",
            " *",
            " * in   t        s      not used: the equations do not contain the time",
            " * in   x[7]            omega_1, omega_2, omega_3 in rad/s, body components; q0 .. q3, body to space",
            f" * in   p[{len(self.form.parameters)}]            of the scene: {self.name}_parameters.h",
            *(f" *        {name:<6} {meaning}" for name, meaning, _ in self.form.parameters),
            " * in   dt       s      size of the step, of either sign",
            " * out  next[7]         the state at t + dt, with a quaternion of norm 1; may be x",
            " * Returns 0; 1 for numbers outside the domain, 2 if the compiler breaks the arithmetic; then next is",
            " * NaN.",
            " *",
            " * Domain: positive moments, finite rates, a quaternion that is not zero.",
            " * Cost: the same for every dt; no heap, no state between calls.",
            f" * Derivation: derivations/{self.form.derivation}.md",
            " * Compile with -std=c99 -ffp-contract=off, without -ffast-math.",
            f" * Generated by `symrot emit {self.scene.name} --step exact --target c`; do not edit.",
            " */",
        ]

    @cached_property
    def _header(self) -> str:
        guard = f"SYMROT_{self.name.upper()}_H"
        return "\n".join([
            *self._banner, f"#ifndef {guard}", f"#define {guard}", "#ifdef __cplusplus", 'extern "C" {', "#endif", "",
            *(f"{self._declaration(real)};" for real in (DOUBLE, FLOAT)), "",
            "#ifdef __cplusplus", "}", "#endif", "#endif",
        ]) + "\n"  # fmt: skip

    @cached_property
    def _source(self) -> str:
        form = self.form
        library = joined(form.library, f"{form.library}_at")
        library = re.sub(rf"\bsymrot_{form.library}_(prepare|length|at)\b", rf"symrot_{self.name}_\1", library)
        count = len(form.parameters)
        factors = [(name, after) for name, after in (("before", False), ("after", True))
                   if any(f" {name}[]" in table for table in form.tables)]  # fmt: skip
        product = [
            "", "static void product(const double a[4], const double b[4], double c[4])", "{",
            "    const double d[4] = {a[0]*b[0] - a[1]*b[1] - a[2]*b[2] - a[3]*b[3],",
            "        a[0]*b[1] + a[1]*b[0] + a[2]*b[3] - a[3]*b[2],",
            "        a[0]*b[2] - a[1]*b[3] + a[2]*b[0] + a[3]*b[1],",
            "        a[0]*b[3] + a[1]*b[2] - a[2]*b[1] + a[3]*b[0]};",
            "    for (int i = 0; i < 4; ++i)", "        c[i] = d[i];", "}",
        ] if factors else []  # fmt: skip
        lines = [
            *self._banner, f'#include "{self.name}.h"', library.rstrip(), *product, "", self._declaration(DOUBLE), "{",
            *form.tables, "    double q[4] = {x[3], x[4], x[5], x[6]};",
            *(f"    product({'q, after' if after else 'before, q'}, q);" for _, after in factors),
            f"    const double moments[{2*count}] = {{{', '.join(f'p[{i}], 0.0' for i in range(count))}}};",
            f"    const double rates[6] = {{{', '.join(f'x[{i}], 0.0' for i in form.named)}}};",
            "    const double attitude[8] = {q[0], 0.0, q[1], 0.0, q[2], 0.0, q[3], 0.0};",
            f"    {form.library} motion;", f"    const int status = symrot_{self.name}_prepare("
            f"{', '.join(form.arguments)}, &motion);",
            "    (void)t;", "    if (status)", "        for (int i = 0; i < 7; ++i)", "            next[i] = NAN;",
            "    else", f"        symrot_{self.name}_at(&motion, 1, &dt, next, next + 3);", "    return status;",
            "}", "",
            self._declaration(FLOAT), "{", f"    double state[7], numbers[{count}];",
            "    for (int i = 0; i < 7; ++i)", "        state[i] = x[i];",
            f"    for (int i = 0; i < {count}; ++i)", "        numbers[i] = p[i];",
            f"    const int status = symrot_{self.name}(t, state, numbers, dt, state);",
            "    for (int i = 0; i < 7; ++i)", "        next[i] = (float)state[i];", "    return status;", "}",
        ]  # fmt: skip
        return "\n".join(lines) + "\n"

    @cached_property
    def _vectors(self) -> list[tuple[list[float], float, list[float]]]:
        """Test vectors (state, dt, state after the step), computed from the closed form with exact constants."""
        vectors = []
        start = [float(x) for x in (*self.scene.initial.omega_b, *self.scene.initial.quaternion)]
        for place, share in enumerate(SHARES):
            state = [
                x + (place + i % 2) / 64 * (max(map(abs, start[:3])) or 1.0) * (i < 3) for i, x in enumerate(start)
            ]
            state[3 + place] += 0.25
            omega, q = [Fraction(x) for x in state[:3]], [Fraction(x) for x in state[3:]]
            dt = float(share) / (sum(x * x for x in state[:3]) ** 0.5 or 1.0)
            rates, attitudes = self.form.motion(omega, q).evaluate([dt])
            vectors.append((state, dt, [*rates[0].tolist(), *attitudes[0].tolist()]))
        return vectors

    @cached_property
    def _test(self) -> str:
        """The text of a C program that compares the step with the test vectors; it exits with 0 if all agree."""

        name, count = f"symrot_{self.name}", len(self.form.parameters)
        checks = []
        for real, tolerance in ((DOUBLE, "4e-15"), (FLOAT, "2e-5")):
            checks += [
                f"static int check{real.suffix}(void)", "{",
                f"    {real.type} x[7], next[7], p[{count}];",
                f"    for (int i = 0; i < {count}; ++i)", f"        p[i] = ({real.type}){name}_parameters[i];",
                f"    for (int k = 0; k < {len(SHARES)}; ++k) {{", "        double rate = 0;",
                "        for (int i = 0; i < 7; ++i)", f"            x[i] = ({real.type})starts[k][i];",
                "        for (int i = 0; i < 3; ++i)", "            rate = fmax(rate, fabs(ends[k][i]));",
                f"        if ({name}{real.suffix}(0, x, p, ({real.type})sizes[k], next))", "            return 1;",
                "        for (int i = 0; i < 7; ++i)",
                f"            if (!(fabs(next[i] - ends[k][i]) <= {tolerance}*(i < 3 ? rate : 1.0)))",
                "                return 1;", "    }", "    return 0;", "}", "",
            ]  # fmt: skip
        return "\n".join([
            f"/* Test of {self.name}: returns 0 if double and float agree with the motion of exact constants. */",
            "#include <math.h>", "#include <stdio.h>", f'#include "{self.name}.h"',
            f'#include "{parameters_file(self.name)}"', "",
            constant_table(f"starts[{len(SHARES)}][7]", [start for start, _, _ in self._vectors]),
            constant_table(f"sizes[{len(SHARES)}]", [dt for _, dt, _ in self._vectors]),
            constant_table(f"ends[{len(SHARES)}][7]", [after for _, _, after in self._vectors]), "", *checks,
            "int main(void)", "{", "    const int failed = check() || checkf();",
            f'    puts(failed ? "{self.name}: differs" : "{self.name}: agrees with the motion");',
            "    return failed;", "}",
        ]) + "\n"  # fmt: skip
