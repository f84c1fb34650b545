"""The texts of one time step of a scene: C with test vectors, NumPy, JavaScript, JAX, and a certificate."""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from numbers import Integral
from typing import Any

from symrot.certificates.step_certificate import StepUnderTest, step_certificate
from symrot.codegen.printing.banner import Description
from symrot.codegen.printing.c_function import DOUBLE, FLOAT, Real, c_name
from symrot.codegen.printing.c_source import c_functions, c_header, with_head
from symrot.codegen.printing.parameters_header import parameters_file
from symrot.codegen.scene_kernels import corner_note
from symrot.codegen.steps import (
    RK4,
    Method,
    RungeKutta,
    SteadyRotations,
    TaylorSeries,
    WithDerivatives,
    derivative_inputs,
    step_program,
    stepped,
)
from symrot.errors import InputError
from symrot.formula.exact_numbers import equal, show
from symrot.formula.program import Program
from symrot.formula.tree import FUNCTIONS
from symrot.kernels.jacobian import jacobian_name
from symrot.kernels.library import is_kernel
from symrot.propagation.steppers.tableau import NODES, STAGE_WEIGHTS, WEIGHTS
from symrot.scene.scene import Scene, SceneSource, load_scene
from symrot.workshop.kernel_text import PRINTERS, Bounds, KernelText, SceneText
from symrot.workshop.steps.files import StepFiles, constant_table
from symrot.workshop.steps.whole_state import WholeState

__all__ = ["ORDER", "STEPS", "StepText", "step_method", "step_text"]

ORDER, LARGEST_ORDER = 8, 16
SIZES = (Fraction(1, 1024), Fraction(1, 64), Fraction(-1, 256))  # sizes of the test vectors, s, for rates near 1/s
DIGITS = 40


def _dop853(order: int) -> RungeKutta:
    """Return the step of order 8 of Dormand and Prince, a Runge-Kutta method, without its error estimates.

    ``order`` is not used, because the method has one order only.
    """
    stages = range(1, 13)
    return RungeKutta(
        "dop853", 8, tuple(Fraction(NODES[i]) for i in stages),
        tuple({j - 1: Fraction(a) for j, a in STAGE_WEIGHTS.get(i, {}).items()} for i in stages),
        {j - 1: Fraction(b) for j, b in WEIGHTS.items()}, rounded=True,
    )  # fmt: skip


STEPS: Mapping[str, Callable[[int], RungeKutta | TaylorSeries]] = {
    "rk4": lambda order: RK4, "taylor": TaylorSeries, "dop853": _dop853,
}  # fmt: skip
"""Name of a method -> function that takes an order and returns the method; only the function of ``taylor`` uses it."""


def step_method(name: str, order: int | None = None, jacobian: Sequence[str] = ()) -> Method:
    """Return the integration method with a given name.

    Parameters
    ----------
    name : str
        ``"rk4"``, ``"taylor"`` or ``"dop853"``.
    order : int, optional
        Order of the Taylor series, 1 to 16; default 8.
    jacobian : sequence of str
        Inputs with respect to which the step is also differentiated, see
        :class:`symrot.codegen.steps.WithDerivatives`.

    Raises
    ------
    InputError
        For an unknown method, or an order that the method does not have.
    """
    if name not in STEPS:
        raise InputError(f"step: expected one of the methods {', '.join(STEPS)}, exact, got {name!r}")
    if order is not None and name != "taylor":
        raise InputError(f"order: expected an order only for the step 'taylor', got {order} for the step '{name}'")
    if order is not None and not (isinstance(order, Integral) and 1 <= order <= LARGEST_ORDER):
        raise InputError(f"order: expected 1 to {LARGEST_ORDER} for the step 'taylor', got {show(order)}")
    if len(set(jacobian)) < len(jacobian):
        raise InputError(f"jacobian: expected each input once, got {', '.join(jacobian)}")
    method = STEPS[name](ORDER if order is None else order)
    return WithDerivatives(method, tuple(jacobian)) if jacobian else method


def step_text(scene: SceneSource, step: str, order: int | None = None, jacobian: Sequence[str] = ()) -> KernelText:
    """Return the texts of one time step of a scene; ``step`` is ``"exact"`` or a method of :func:`step_method`."""
    # a library kernel has no motion
    if isinstance(scene, str) and is_kernel(scene):
        raise InputError(f"step: expected a scene, because only a motion has steps, got the kernel {scene!r}")
    if step == "exact":
        return _exact(load_scene(scene), order, jacobian)
    # ``order`` is the order of a Taylor series; ``jacobian`` names the inputs for derivatives of the step
    text = StepText(load_scene(scene), step_method(step, order, jacobian))
    for name in jacobian:
        derivative_inputs(text.rates.program, name)
    return text


def _exact(scene: Scene, order: int | None, jacobian: Sequence[str]) -> KernelText:
    if order is not None or jacobian:
        option = "order" if order is not None else "jacobian"
        raise InputError(f"{option}: expected no value for the step 'exact', got {order or ', '.join(jacobian)}")
    if (method := _steady_rotations(scene)) is not None:
        return StepText(scene, method)
    from symrot.workshop.steps.exact import ExactStepText

    return ExactStepText(scene)


def _steady_rotations(scene: Scene) -> SteadyRotations | None:
    """Return the closed form of a scene's motion if its attitude is a product of steady rotations, otherwise None.

    It is known for a free sphere or symmetric body, also with one rotor along the symmetry axis, if the inertia tensor
    that the scene gives is diagonal (the body axes are principal axes).
    """
    kinds, principal = [torque.kind for torque in scene.torques], scene.body.principal
    if not principal.given_axes or kinds not in ([], ["rotor"]):
        return None
    moments = [scene.body.inertia[i][i] for i in range(3)]
    if not kinds and equal(moments[0], moments[1]) and equal(moments[1], moments[2]):
        return SteadyRotations(None)
    rotor = scene.torques[0].vector("angular_momentum") if kinds else (Fraction(0),) * 3
    for axis in range(3):
        if equal(moments[axis - 2], moments[axis - 1]) and not rotor[axis - 2] and not rotor[axis - 1]:
            return SteadyRotations(axis)
    return None


class StepText(StepFiles):
    """The texts of one step of a scene's motion with a fixed method.

    Parameters
    ----------
    scene : Scene
        As for :class:`SceneText`.
    method : Method
        The method, see :func:`step_method`.
    """

    def __init__(self, scene: Scene, method: Method) -> None:
        self.rates = WholeState(scene) if isinstance(method, SteadyRotations) else SceneText(scene)
        self.method = method
        self.name = f"{self.rates.name.removesuffix('_rates')}_{method.name}_step"
        if isinstance(method, WithDerivatives):
            self.name = jacobian_name(self.name, method.by)

    @cached_property
    def _rates_program(self) -> Program:
        return self.rates.program

    @cached_property
    def _program(self) -> Program:
        try:
            return step_program(self._rates_program, self.method, self.name)
        except InputError as reason:
            raise InputError(f"{self.rates.scene.name}: {reason}") from None

    def _description(self, target: str) -> Description:
        scene, order, exact = self.rates.scene, "", isinstance(self.method, SteadyRotations)
        plain, jacobian, slopes = self.method, "", ""
        if isinstance(plain, WithDerivatives):
            jacobian, slopes = f" --jacobian {','.join(plain.by)}", "; with its derivatives, row by row"
            plain = plain.plain
        if isinstance(plain, TaylorSeries) and plain.order != ORDER:
            order = f" --order {plain.order}"
        contract = (
            ("Method", self.method.formula),
            *((("Parameters", "those of the scene are in {kernel}_parameters.h"),) if self._parameter_names else ()),
            ("Test", "{kernel}_test.c compares the functions with values of 40 digits"),
            (
                "Certificate",
                f"{{kernel}}.cert.json: the text computes the {'motion' if exact else 'formula of the method'}",
            ),
            *((("Errors", "rounding alone; it grows with the angle |omega| dt"),) if exact else ()),
            ("Assumes", "IEEE 754 arithmetic, rounding to nearest; next does not overlap x"),
        )
        note = ""
        if isinstance(self.method, WithDerivatives) or isinstance(plain, TaylorSeries):
            note = corner_note(self._program, "the results")
        return Description(
            title=f"one time step of the scene {scene.name!r} ({scene.title}): next is the state at t + dt{slopes}",
            domain=f"all states of finite size{note}; the norm of a quaternion drifts with the {self._drift}",
            derivation=self._derivation,
            command=f"symrot emit {scene.name} --step {self.method.name}{order}{jacobian} --target {target}",
            contract=contract if target == "c" else contract[:1],
        )  # fmt: skip

    @property
    def _drift(self) -> str:
        return "rounding errors" if isinstance(self.method, SteadyRotations) else "error of the method"

    @property
    def _derivation(self) -> str:
        """The paths of the pages that derive the formulas of the step, separated by commas."""
        if isinstance(self.method, SteadyRotations):
            return f"derivations/{'spherical_body' if self.method.axis is None else 'symmetric_gyrostat'}.md"
        return "derivations/euler_equations.md, derivations/quaternion_rates.md"

    @cached_property
    def _source_and_header(self) -> tuple[str, str]:
        reals, description = (DOUBLE, FLOAT), self._description("c")
        return (
            with_head(self._program, description, c_functions(self._program, reals)),
            c_header(self._program, description, reals),
        )

    def _printed(self, target: str) -> str:
        return PRINTERS[target](self._program, self._description(target))

    @cached_property
    def certified(self) -> StepUnderTest:
        """The method and the texts of the step as one object, from which the certificate is made."""
        description = self._description("c")
        return StepUnderTest(
            self.name, description.title, description.command, self._rates_program, self.method,
            tuple(self.rates.inputs.parameters), self.c_files(),
        )  # fmt: skip

    def certificate(self, bounds: Bounds | None = None) -> str:
        """Return the text of the certificate, without bounds of errors; ``bounds`` is not used.

        CertificateError is raised if the C text does not compute the formulas of the integration method.
        """
        return step_certificate(self.certified)

    @cached_property
    def _vectors(self) -> list[tuple[list[float], float, list[float]]]:
        """Test vectors: (state, step size, state after the step), computed with 40 digits from the method's formula."""
        import mpmath

        states = [name for name, *_ in self._rates_program.signature.argument("y").components]
        parameters = dict(self._parameters)
        functions = {name: abs if name == "abs" else getattr(mpmath, name) for name in (*FUNCTIONS, "sinc")}
        vectors = []
        with mpmath.workdps(DIGITS):
            for place, size in enumerate(SIZES):
                start = [float((Fraction(-1) ** i) * Fraction(i + 2 + place, 7)) for i in range(len(states))]
                values: dict[str, Any] = {
                    name: mpmath.mpf(x) for name, x in (parameters | dict(zip(states, start, strict=True))).items()
                }
                scale = 1 + max(map(abs, parameters.values()), default=0.0)
                dt = float(size) / 2 ** int(scale).bit_length()
                after = stepped(
                    self._rates_program, self.method, values | {"t": mpmath.mpf(0)}, mpmath.mpf(dt), functions,
                    lambda value: mpmath.mpf(value.numerator) / value.denominator,
                )  # fmt: skip
                vectors.append((start, dt, [float(each) for each in after]))
        return vectors

    @property
    def _parameters(self) -> list[tuple[str, float]]:
        return list(zip(self._parameter_names, self.rates.inputs.parameters, strict=True))

    @property
    def _parameter_names(self) -> list[str]:
        return [name for a in self._rates_program.signature.arguments if a.name == "p" for name, *_ in a.components]

    @cached_property
    def _test(self) -> str:
        """The text of a C program that compares the step with the test vectors; it exits with 0 if all agree."""
        count, outputs, parameters = len(self._vectors[0][0]), len(self._vectors[0][2]), self.rates.inputs.parameters
        columns = "STATES" if outputs == count else "OUTPUTS"
        included = [f'#include "{parameters_file(self.name)}"'] if parameters else []
        return "\n".join([
            f"/* Test of {self.name}: returns 0 if double and float agree with values of {DIGITS} digits. */",
            "#include <math.h>", "#include <stdio.h>", f'#include "{self.name}.h"', *included, "",
            f"#define STATES {count}", *([] if outputs == count else [f"#define OUTPUTS {outputs}"]),
            f"#define VECTORS {len(self._vectors)}", "",
            constant_table(f"vectors[VECTORS][2][{columns}]", [[start, after] for start, _, after in self._vectors]),
            constant_table("sizes[VECTORS]", [dt for _, dt, _ in self._vectors]),
            "", *self._check(DOUBLE, "1e-14"), "", *self._check(FLOAT, "4e-6"), "",
            "int main(void)", "{", "    const int failed = check() || checkf();",
            f'    puts(failed ? "{self.name}: differs" : "{self.name}: agrees with {DIGITS} digits");',
            "    return failed;", "}",
        ]) + "\n"  # fmt: skip

    def _check(self, real: Real, tolerance: str) -> list[str]:
        parameters = self.rates.inputs.parameters
        copies = [f"    {real.type} p[{len(parameters)}];",
                  f"    for (int i = 0; i < {len(parameters)}; ++i)",
                  f"        p[i] = ({real.type})symrot_{self.name}_parameters[i];"] if parameters else []  # fmt: skip
        sizes = [a.size for a in self._program.signature.arguments if a.role == "out"]
        results = ["next", *(f"next + {sum(sizes[:place])}" for place in range(1, len(sizes)))]
        columns = "STATES" if len(sizes) == 1 else "OUTPUTS"
        called = ", ".join(["0", "x", *(["p"] if parameters else []), f"({real.type})sizes[k]", *results])
        return [
            f"static int check{real.suffix}(void)", "{", f"    {real.type} x[STATES], next[{columns}];", *copies,
            "    for (int k = 0; k < VECTORS; ++k) {", "        double scale = 1;",
            "        for (int i = 0; i < STATES; ++i)" + (" {" if columns == "STATES" else ""),
            f"            x[i] = ({real.type})vectors[k][0][i];",
            *([] if columns == "STATES" else ["        for (int i = 0; i < OUTPUTS; ++i)"]),
            "            scale = fmax(scale, fabs(vectors[k][1][i]));", *(["        }"] if columns == "STATES" else []),
            f"        {c_name(self.name, real)}({called});", f"        for (int i = 0; i < {columns}; ++i)",
            f"            if (!(fabs(next[i] - vectors[k][1][i]) <= {tolerance}*scale))", "                return 1;",
            "    }", "    return 0;", "}",
        ]  # fmt: skip
