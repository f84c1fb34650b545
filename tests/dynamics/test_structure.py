"""The structure of a motion as text, the key under which its kernel is cached."""

import json
from dataclasses import replace

import pytest

from symrot.dynamics.structure import FieldTorque, FormulaTorque, InertiaTensor, Pattern, PrincipalInertia, Structure
from symrot.planning.general_structure import switched
from symrot.planning.plan import make_plan
from symrot.propagation.compiled_models import kernel_key
from symrot.scene.scene import load_scene, shipped_scenes

ZERO, ONE, MINUS_ONE, FREE = Pattern
SCENES = [name for name, *_ in shipped_scenes()]
PUSH = FieldTorque("constant_body", "", (("torque", (FREE, ZERO, ZERO)),))
TABLE = FormulaTorque("", ("k*t", "0", "0"), ("k",), "body")
BASE = Structure(PrincipalInertia(), (PUSH, TABLE))
CHANGES = {
    "equal moments": replace(BASE, inertia=PrincipalInertia("AAC")),
    "tensor": replace(BASE, inertia=InertiaTensor(("I_xx", "I_yy", "I_zz"))),
    "no torque": replace(BASE, torques=()),
    "order of torques": replace(BASE, torques=(TABLE, PUSH)),
    "pattern": replace(BASE, torques=(PUSH._replace(fields=(("torque", (FREE, ONE, ZERO)),)), TABLE)),
    "kind": replace(BASE, torques=(PUSH._replace(kind="constant_space"), TABLE)),
    "prefix": replace(BASE, torques=(PUSH._replace(prefix="torque1_"), TABLE)),
    "formula": replace(BASE, torques=(PUSH, TABLE._replace(formulas=("k*t", "0", "t")))),
    "frame": replace(BASE, torques=(PUSH, TABLE._replace(frame="space"))),
    "mode held": replace(BASE, torques=(PUSH, TABLE._replace(held=("k",)))),
    "attitude": replace(BASE, attitude=False),
    "planar": replace(BASE, planar=2),
    "first axis": replace(BASE, planar=0),
    "start": replace(BASE, planar=2, initial_quaternion=(ONE, ZERO, ZERO, ZERO)),
    "other start": replace(BASE, planar=2, initial_quaternion=(MINUS_ONE, ZERO, ZERO, ZERO)),
    "constant": replace(BASE, constant=(None, None, FREE)),
    "constant zero": replace(BASE, constant=(None, None, ZERO)),
    "clock": replace(BASE, clock="epoch"),
    "sequence": replace(BASE, sequence="ZXZ"),
}


def text(structure):
    return json.dumps(structure.to_json())


def test_every_part_of_a_structure_is_in_its_text():
    texts = {text(structure) for structure in (BASE, *CHANGES.values())}
    assert len(texts) == 1 + len(CHANGES)


def structures_of(name):
    scene = load_scene(name)
    return [row.structure for row in make_plan(scene, external_torque=True, switched=switched(scene)).rows] + (
        [] if scene.table else [row.structure for row in make_plan(scene, switched=switched(scene)).rows]
    )


def test_structures_of_scenes_are_equal_where_their_texts_are():
    structures = [structure for name in SCENES for structure in structures_of(name)]
    texts = {id(structure): text(structure) for structure in structures}
    for one in structures:
        for other in structures:
            assert (one == other) is (texts[id(one)] == texts[id(other)])
            assert one != other or hash(one) == hash(other)
    assert len(set(structures)) >= len(SCENES) // 2


@pytest.mark.parametrize("name", ["t_handle", "heavy_top_loops"])
def test_numbers_are_not_part_of_the_key_of_a_kernel(name):
    plan = make_plan(load_scene(name))
    x, y, z = plan.scene.initial.omega_b
    other = make_plan(plan.scene, plan.scene.initial._replace(omega_b=(2 * x, 2 * y, 2 * z)))
    assert kernel_key(plan) == kernel_key(other)


@pytest.mark.parametrize("field", ["torque", "weight"])
def test_a_field_is_a_number_or_a_vector(field):
    """Asking for a number in place of a vector, or the reverse, raises an error."""
    gravity = FieldTorque("gravity", "", (("weight", FREE), ("torque", (FREE, ZERO, ZERO))))
    ask = gravity.number if field == "torque" else gravity.vector
    with pytest.raises(AssertionError):
        ask(field)
