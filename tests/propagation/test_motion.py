"""Each class of motions is abstract or final, and overrides nothing concrete; and what a trajectory needs of its scene."""

import inspect
from abc import ABC, abstractmethod
from functools import cached_property
from typing import final

import pytest

import symrot
from symrot.errors import InputError
from symrot.propagation import euler_state, external_torque
from symrot.propagation.motions import methods, motion
from symrot.propagation.switched import motion as switched

FINAL = {
    methods.ConstantMotion, methods.ClosedFormMotion, methods.SteppedMotion, methods.SciPyMotion,
    external_torque.ExternallyDrivenMotion, switched.SwitchedMotion, euler_state.EulerMotion,
}  # fmt: skip
MEMBERS = (property, cached_property, staticmethod, classmethod)


def descendants(base):
    """Return all classes below a class."""
    return {base}.union(*map(descendants, base.__subclasses__()))


def faults(base):
    """Return the faults of a hierarchy: classes neither abstract nor final, subclasses of final ones, overridden
    members.
    """
    listed = []
    for each in descendants(base):
        name, is_final = each.__name__, getattr(each, "__final__", False)
        if inspect.isabstract(each) == is_final:
            listed.append(f"{name}: neither abstract nor final")
        if is_final and each.__subclasses__():
            listed.append(f"{name}: final, with subclasses")
        for member, value in vars(each).items():
            if member == "__init__" or not (inspect.isfunction(value) or isinstance(value, MEMBERS)):
                continue
            for parent in each.__mro__[1:-1]:
                above = vars(parent).get(member)
                if above is not None and not getattr(above, "__isabstractmethod__", False):
                    listed.append(f"{name}.{member}: overrides {parent.__name__}")
    return listed


def test_motions_are_abstract_or_final():
    assert faults(motion.Motion) == []
    assert {each for each in descendants(motion.Motion) if not inspect.isabstract(each)} == FINAL


@pytest.mark.parametrize("fault", ["neither", "overrides", "subclasses"])
def test_other_hierarchies_are_seen(fault):
    class Base(ABC):
        @abstractmethod
        def follow(self): ...

        def integrate(self):
            return self.follow()

    @final
    class Sound(Base):
        def follow(self): ...

    assert faults(Base) == []
    if fault == "neither":
        type("Open", (Base,), {"follow": lambda self: None})
    elif fault == "overrides":
        final(type("Bold", (Base,), {"follow": lambda self: None, "integrate": lambda self: None}))
    else:
        final(type("Heir", (Sound,), {}))
    assert any(fault in line for line in faults(Base))


def test_each_motion_runs_the_constructor_of_its_base():
    """So every motion holds the setup and the plan that properties of the base class read."""
    for each in FINAL:
        constructor = vars(each).get("__init__")
        assert constructor is None or "super().__init__(" in inspect.getsource(constructor), each.__name__


def test_an_unknown_quantity_is_refused_with_a_hint():
    with pytest.raises(InputError, match=r"quantity: expected one of omega, .* got 'enrgy' \(did you mean 'energy'"):
        symrot.propagate("t_handle").quantity("enrgy")


def test_euler_angles_need_a_sequence():
    trajectory = symrot.propagate("t_handle")
    with pytest.raises(InputError, match=r"expected an Euler sequence, such as .ZXZ., as output\.sequence"):
        trajectory.quantity("euler")
    assert trajectory.euler("ZXZ").shape == (len(trajectory), 3)
