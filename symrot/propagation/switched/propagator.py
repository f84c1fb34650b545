"""The propagator of scenes whose torques jump or bend."""

from symrot.planning.plan import Plan, make_plan
from symrot.propagation.method import choose_method
from symrot.propagation.motions.motion import Motion
from symrot.propagation.propagator import Propagator
from symrot.propagation.switched.motion import SwitchedMotion
from symrot.scene.tables import Initial

__all__ = ["SwitchedPropagator"]


class SwitchedPropagator(Propagator):
    """Propagator of a scene with switching functions (sign, abs, ..) in its torques; see :func:`symrot.propagator`."""

    def _planned(self, initial: Initial | None = None) -> Plan:
        return make_plan(self.scene, initial, switched=True)

    def _prepare(self, plan: Plan) -> Motion:
        return SwitchedMotion(plan, choose_method(plan, self._method), self.tolerance)
