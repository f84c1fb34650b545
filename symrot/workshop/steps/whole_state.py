"""The rates of a scene's whole state: of all components of omega and of the quaternion, even of constant ones.

The whole state is what an exact step takes and returns: a time step that computes the closed form of the motion.
"""

from dataclasses import replace
from fractions import Fraction

from symrot.dynamics.structure import MOVING
from symrot.formula.tree import evaluate
from symrot.planning.plan import make_plan
from symrot.scene.scene import Scene
from symrot.workshop.kernel_text import SceneText, scene_kernel_name

__all__ = ["WholeState"]


class WholeState(SceneText):
    """The rates of a scene whose state has all components of omega and of the quaternion, including constant ones."""

    def __init__(self, scene: Scene) -> None:
        plan = make_plan(scene)
        whole = replace(plan.structure, attitude=True, planar=None, initial_quaternion=None, constant=MOVING)
        self.plan, self.scene, self.jacobian = replace(plan, structure=whole), plan.scene, ()
        self.name = scene_kernel_name(self.scene.name)

    @property
    def exact_parameters(self) -> dict[str, Fraction]:
        """The exact value of each parameter of the rates, by name, such as ``{"p0": Fraction(3, 5)}``."""
        constants = self.plan.constants
        return {name: evaluate(node, constants, {}, lambda x: x) for name, node in self.inputs.formulas.values()}
