"""Scenes that cannot be used, each with words that its error message must contain.

``CONTENTS`` are whole files: (name, bytes, words). ``CHANGES`` change one table of a good scene: (name, base, TOML that
replaces a table, words). The tests of the command line import both.
"""

__all__ = ["CHANGES", "CONTENTS", "bad_scenes", "base_scene"]

BODY = "[body]\nprincipal = [1, 2, 2.5]\n"
SHAPE = '[body]\nshape = "box"\na = 1\nb = 2\nc = 3\nmass = 6\n'
TOP = SHAPE + 'about = "fixed_point"\nfixed_point = [0, 0, -1]\n'
PARTS = '[[body.part]]\nshape = "sphere"\nradius = 1\nmass = 1\n'
INITIAL = "[initial]\nomega = [0, 0.1, 1]\n"
SPAN = "[span]\nt = [0, 10]\nsamples = 11\n"

TABLES = {"head": "schema = 1\n", "body": BODY, "initial": INITIAL, "torque": "", "span": SPAN, "output": "",
          "accuracy": ""}  # fmt: skip


def base_scene(**tables: str) -> str:
    """Return a good scene as text, in which some tables are replaced."""
    return "\n".join({**TABLES, **tables}.values())


GOOD = base_scene()

CONTENTS = [
    ("empty file", b"", ("empty",)),
    ("blank file", b" \n\n\t", ("empty",)),
    ("binary file", bytes(range(256)) * 4, ("UTF-8", "0x80")),
    ("zip file", b"PK\x03\x04\x14\x00\x00\x00\x08\x00", ("TOML", "line 1")),
    ("utf-16 file", GOOD.encode("utf-16"), ("UTF-8",)),
    ("50 MB file", b"#" * 50_000_000, ("1 MB",)),
    ("toml syntax", b"schema = 1\n[body\nmass = 1\n", ("TOML", "line 2")),
    ("same key twice", b"schema = 1\nschema = 1\n", ("TOML", "line 2")),
    ("only a comment", b"# a scene\n", ("schema", "missing")),
    ("nested too deeply", b"schema = " + b"[" * 20_000, ("TOML",)),
    ("integer of 5000 digits", b"schema = " + b"9" * 5000, ("TOML", "4300")),
    ("JSON", b'{"schema": 1}', ("TOML", "line 1")),
]


def _body(text: str) -> dict[str, str]:
    return {"body": f"[body]\n{text}\n"}


def _torque(text: str, body: str = BODY) -> dict[str, str]:
    return {"body": body, "torque": f"[[torque]]\n{text}\n"}


def _formula(text: str) -> dict[str, str]:
    return _torque(f'kind = "expression"\ntorque = [0, 0, {text}]\nparameters = {{ k = 0.1 }}')


def _attitude(text: str) -> dict[str, str]:
    return {"initial": f"{INITIAL}attitude = {{ {text} }}\n"}


CHANGES = [
    # the whole
    ("schema missing", {"head": ""}, ("schema", "missing")),
    ("schema 2", {"head": "schema = 2"}, ("schema", "1", "got 2")),
    ("schema true", {"head": "schema = true"}, ("schema", "got true")),
    ("unknown table", {"torque": "[[torques]]\nkind = \"rotor\""}, ("torques", "did you mean 'torque'")),
    ("unknown key at the top", {"head": "schema = 1\ntitel = 'x'"}, ("titel", "did you mean 'title'")),
    ("title is a number", {"head": "schema = 1\ntitle = 5"}, ("title", "text", "got 5")),
    ("title that clears the screen", {"head": 'schema = 1\ntitle = "\\u001b[2J"'}, ("title", "line", "x1b")),
    ("key of two lines", {"head": 'schema = 1\n"a\\nb" = 1'}, (": 'a\\nb': ", "unknown key")),
    ("a date", {"head": "schema = 1\ntitle = 2024-01-01"}, ("title", "text", "2024")),
    ("no body", {"body": ""}, ("body", "missing")),
    ("body is a number", {"head": "schema = 1\nbody = 3", "body": ""}, ("body", "table", "got 3")),
    ("no initial state", {"initial": ""}, ("initial", "missing")),
    ("no span", {"span": ""}, ("span", "missing")),
    # the body
    ("no inertia", _body("mass = 1"), ("body", "exactly one of shape")),
    ("two ways of inertia", _body("principal = [1, 1, 1]\nshape = 'sphere'"), ("shape and principal",)),
    ("unknown shape", _body("shape = 'boks'\nmass = 1"), ("body.shape", "'boks'", "did you mean 'box'")),
    ("shape is a part", _body("shape = 'part:other'\nmass = 1"), ("body.shape", "part:other", "box")),
    ("shape is a list", _body("shape = ['box']\nmass = 1"), ("body.shape", "'box'")),
    ("unknown key of a shape", {"body": SHAPE + "widht = 1"}, ("body.widht", "unknown key", "a box")),
    ("missing dimension", _body("shape = 'box'\na = 1\nb = 1\nmass = 1"), ("body.c", "missing", "a box")),
    ("dimension 0", _body("shape = 'sphere'\nradius = 0\nmass = 1"), ("body.radius", "positive", "got 0")),
    ("dimension -1", _body("shape = 'sphere'\nradius = -1\nmass = 1"), ("body.radius", "positive", "got -1")),
    ("dimension with a unit", _body("shape = 'sphere'\nradius = '1 m'\nmass = 1"), ("body.radius", "'1 m'", "unit")),
    ("dimension out of range", _body("shape = 'sphere'\nradius = 1e200\nmass = 1"), ("body.radius", "1e100")),
    ("moments out of range", _body("shape = 'sphere'\nradius = 1e99\nmass = 1e90"), ("body.shape", "1e120")),
    ("dimension is a bool", _body("shape = 'sphere'\nradius = true\nmass = 1"), ("body.radius", "got true")),
    ("inner > outer", _body("shape = 'hollow_sphere'\ninner = 2\nouter = 1\nmass = 1"), ("inner < outer", "2")),
    ("tube > ring", _body("shape = 'torus'\nring = 1\ntube = 2\nmass = 1"), ("tube <= ring", "2")),
    ("no mass", _body("shape = 'sphere'\nradius = 1"), ("body.mass", "mass (kg)", "density (kg/m^3)", "neither")),
    ("mass and density", _body("shape = 'sphere'\nradius = 1\nmass = 1\ndensity = 1"),
     ("body.mass", "got {mass = 1, density = 1}")),
    ("mass 0", _body("shape = 'sphere'\nradius = 1\nmass = 0"), ("body.mass", "positive mass", "got 0")),
    ("mass -1", _body("shape = 'sphere'\nradius = 1\nmass = -1"), ("body.mass", "positive mass", "got -1")),
    ("mass is text", _body("shape = 'sphere'\nradius = 1\nmass = 'four'"), ("body.mass", "'four'")),
    ("mass with a unit", _body("shape = 'sphere'\nradius = 1\nmass = '1 kg'"), ("body.mass", "'1 kg'", "unit")),
    ("density -2", _body("shape = 'sphere'\nradius = 1\ndensity = -2"), ("body.density", "positive density", "got -2")),
    ("density of q", _body("shape = 'sphere'\nradius = 1\ndensity = 'x*q'"), ("body.density", "x, y, z", "x*q")),
    ("negative mass by density", _body("shape = 'sphere'\nradius = 1\ndensity = '-x**2'"), ("body", "mass", "-x**2")),
    ("needle", _body("shape = 'rod'\nlength = 1\nmass = 1"), ("body.shape", "needle", "'rod'")),
    ("point", _body("shape = 'point_masses'\nmasses = [1, 2]\npoints = [[1, 1, 1], [1, 1, 1]]"),
     ("body.shape", "a point has")),
    ("masses and points", _body("shape = 'point_masses'\nmasses = [1, 2]\npoints = [[1, 1, 1]]"),
     ("body", "2 masses", "1 points")),
    ("flat tetrahedron", _body("shape = 'tetrahedron'\nmass = 1\nvertices = [[0,0,0],[1,0,0],[0,1,0],[1,1,0]]"),
     ("body", "tetrahedron", "plane")),
    ("two moments", _body("principal = [1, 2]"), ("body.principal", "three", "[1, 2]")),
    ("moments as text", _body("principal = '1, 2, 3'"), ("body.principal", "three", "'1, 2, 3'")),
    ("moment -1", _body("principal = [1, 1, -1]"), ("body.principal[2]", "zero or more", "got -1")),
    ("moment nan", _body("principal = [1, 1, nan]"), ("body.principal[2]", "got nan")),
    ("moment inf", _body("principal = [1, 1, inf]"), ("body.principal[2]", "got inf")),
    ("moment 1e400", _body("principal = [1, 1, 1e400]"), ("body.principal[2]", "1e+400")),
    ("moment 1e999999999", _body("principal = [1, 1, 1e999999999]"), ("body.principal[2]", "1e+999999999")),
    ("triangle inequality", _body("principal = [1, 2, 3.5]"), ("body.principal", "exceeds", "3.5")),
    ("needle by moments", _body("principal = [1, 1, 0]"), ("body.principal", "needle", "[1, 1, 0]")),
    ("no moments", _body("principal = [0, 0, 0]"), ("body.principal", "[0, 0, 0]")),
    ("tensor not positive", _body("inertia = {xx = 1, yy = 1, zz = 1, xy = 2}"), ("body.inertia", "-1")),
    ("tensor key", _body("inertia = {xx = 1, yy = 1, zz = 1, yx = 0}"), ("body.inertia.yx", "did you mean")),
    ("tensor without zz", _body("inertia = {xx = 1, yy = 1}"), ("body.inertia.zz", "missing")),
    ("tensor as rows", _body("inertia = [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]"),
     ("body.inertia[0][1]", "a symmetric tensor", "[0.1, 0")),
    ("tensor of two rows", _body("inertia = [[1, 0, 0], [0, 1, 0]]"), ("body.inertia", "three rows", "[[1, 0, 0]")),
    ("about what", {"body": SHAPE + "about = 'origin'"}, ("body.about", "fixed_point", "'origin'")),
    ("fixed point missing", {"body": SHAPE + "about = 'fixed_point'"}, ("body.fixed_point", "missing")),
    ("fixed point unused", {"body": SHAPE + "fixed_point = [0, 0, 1]"}, ("body.fixed_point", "about")),
    ("fixed point of moments", {"body": BODY + "about = 'fixed_point'\nfixed_point = [0, 0, 1]"},
     ("body.fixed_point", "[0, 0, 1]")),
    ("centre of mass off itself", {"body": BODY + "center_of_mass = [0, 0, 1]"}, ("body.center_of_mass", "[0, 0, 1]")),
    # the parts
    ("one part as a table", {"body": PARTS.replace("[[", "[").replace("]]", "]")}, ("body.part", "[[body.part]]")),
    ("no parts", _body("part = []"), ("body.part", "1 to 1000", "got 0")),
    ("part without shape", {"body": "[[body.part]]\nmass = 1"}, ("body.part[0].shape", "missing")),
    ("part of unknown shape", {"body": "[[body.part]]\nshape = 'shpere'"},
     ("body.part[0].shape", "'shpere'", "did you mean 'sphere'")),
    ("part at a number", {"body": PARTS + "at = 3"}, ("body.part[0].at", "got 3")),
    ("part turned by a word", {"body": PARTS + "rotate = 'up'"}, ("body.part[0].rotate", "'up'", "axis")),
    ("part subtracted by 1", {"body": PARTS + "subtract = 1"}, ("body.part[0].subtract", "true or false", "got 1")),
    ("only holes", {"body": PARTS + "subtract = true"}, ("body.part", "mass")),
    ("hole larger than the body", {"body": f"{PARTS}{PARTS.replace('mass = 1', 'mass = 2')}subtract = true"},
     ("body.part", "positive total mass", "-1")),
    ("hole wider than the body", {"body": f"{PARTS}{PARTS.replace('1', '5').replace('mass = 5', 'mass = 0.9')}"
     "subtract = true"}, ("body.part", "moments", "-")),
    ("name of a part", {"body": PARTS + "colour = 'red'"}, ("body.part[0].colour", "unknown key")),
    # the initial state
    ("no omega", {"initial": "[initial]\nattitude = { quaternion = [1, 0, 0, 0] }"}, ("initial.omega", "neither")),
    ("two omegas", {"initial": INITIAL + "omega_space = [0, 0, 1]"}, ("initial.omega", "omega_space = [0, 0, 1]")),
    ("omega of two", {"initial": "[initial]\nomega = [1, 2]"}, ("initial.omega", "three", "[1, 2]")),
    ("omega is text", {"initial": "[initial]\nomega = [1, 2, 'fast']"}, ("initial.omega[2]", "'fast'")),
    ("omega nan", {"initial": "[initial]\nomega = [1, 2, nan]"}, ("initial.omega[2]", "got nan")),
    ("omega with a unit", {"initial": "[initial]\nomega = [1, 2, '3 rad/s']"}, ("initial.omega[2]", "'3 rad/s'")),
    ("omega calls a function", {"initial": "[initial]\nomega = [1, 2, \"__import__('os')\"]"},
     ("initial.omega[2]", "__import__")),
    ("a tower of powers", {"initial": "[initial]\nomega = [1, 2, '9**9**9']"}, ("initial.omega[2]", "9**9**9")),
    ("a million brackets", {"initial": f"[initial]\nomega = [1, 2, '{'(' * 10_000}']"}, ("initial.omega[2]", "10000")),
    ("division by zero", {"initial": "[initial]\nomega = [1, 2, '1/0']"}, ("initial.omega[2]", "'1/0'", "zero")),
    ("quaternion zero", _attitude("quaternion = [0, 0, 0, 0]"), ("attitude.quaternion", "not zero", "[0, 0, 0, 0]")),
    ("quaternion of three", _attitude("quaternion = [1, 0, 0]"), ("attitude.quaternion", "four", "[1, 0, 0]")),
    ("attitude of nothing", _attitude(""), ("initial.attitude", "quaternion", "axis")),
    ("attitude twice", _attitude("quaternion = [1, 0, 0, 0], axis = [0, 0, 1]"), ("attitude.axis", "unknown key")),
    ("axis zero", _attitude("axis = [0, 0, 0], angle = 1"), ("attitude.axis", "not all zero", "[0, 0, 0]")),
    ("axis without angle", _attitude("axis = [0, 0, 1]"), ("attitude.angle", "missing")),
    ("angle is text", _attitude("axis = [0, 0, 1], angle = '90 degrees'"), ("attitude.angle", "'90 degrees'")),
    ("degrees is a number", _attitude("axis = [0, 0, 1], angle = 1, degrees = 1"), ("attitude.degrees", "got 1")),
    ("mixed case sequence", _attitude("sequence = 'ZxZ', angles = [0, 0, 0]"), ("attitude.sequence", "'ZxZ'", "case")),
    ("repeated axis", _attitude("sequence = 'XXZ', angles = [0, 0, 0]"), ("attitude.sequence", "'XXZ'")),
    ("two angles", _attitude("sequence = 'ZXZ', angles = [0, 0]"), ("attitude.angles", "three", "[0, 0]")),
    ("sequence missing", _attitude("angles = [0, 0, 0]"), ("attitude.sequence", "missing")),
    ("reflection", _attitude("dcm = [[1,0,0],[0,1,0],[0,0,-1]]"), ("attitude.dcm", "reflection", "-1")),
    ("not orthogonal", _attitude("dcm = [[1,0,0],[0,1,0],[0,0.1,1]]"), ("attitude.dcm", "orthonormal", "0.1")),
    ("dcm of two rows", _attitude("dcm = [[1,0,0],[0,1,0]]"), ("attitude.dcm", "three rows")),
    # torques
    ("torque as a table", {"torque": "[torque]\nkind = 'rotor'"}, ("torque", "[[torque]]")),
    ("torque without kind", _torque("torque = [1, 0, 0]"), ("torque[0].kind", "missing", "gravity")),
    ("unknown kind", _torque("kind = 'dampning'"), ("torque[0].kind", "'dampning'", "did you mean 'damping'")),
    ("unknown key of a torque", _torque("kind = 'rotor'\nmomentum = [0, 0, 1]"), ("torque[0].momentum", "rotor")),
    ("missing key of a torque", _torque("kind = 'spring'\nstiffness = 1"), ("torque[0].attitude", "missing")),
    ("damping without a value", _torque("kind = 'damping'"), ("torque[0]", "linear or quadratic")),
    ("damping that drives", _torque("kind = 'damping'\nlinear = -0.1"), ("torque[0].linear", "zero or more", "-0.1")),
    ("spring without stiffness", _torque("kind = 'spring'\nstiffness = 0\nattitude = {quaternion = [1, 0, 0, 0]}"),
     ("torque[0].stiffness", "positive", "got 0")),
    ("gravity about the centre", _torque("kind = 'gravity'\nweight = 9.81"), ("torque[0].kind", "fixed_point")),
    ("gravity without weight", _torque("kind = 'gravity'", TOP), ("torque[0].weight", "missing")),
    ("gravity twice", _torque("kind = 'gravity'\nweight = 1\ngravity = 9.81", TOP), ("torque[0].gravity", "not both")),
    ("gravity of no mass", _torque("kind = 'gravity'\ngravity = 9.81", BODY + "about = 'fixed_point'"),
     ("torque[0].gravity", "mass", "unknown")),
    ("gravity where", _torque("kind = 'gravity'\nweight = 9.81", BODY + "about = 'fixed_point'"),
     ("torque[0].center_of_mass", "unknown")),
    ("gravity elsewhere", _torque("kind = 'gravity'\nweight = 1\ncenter_of_mass = [0, 0, 2]", TOP),
     ("torque[0].center_of_mass", "[0.0, 0.0, 1.0]", "[0.0, 0.0, 2.0]")),
    ("gravity at the centre", _torque("kind = 'gravity'\nweight = 1", TOP.replace("-1", "0")), ("torque[0]", "away")),
    ("gravity nowhere", _torque("kind = 'gravity'\nweight = 1\ndirection = [0, 0, 0]", TOP),
     ("torque[0].direction", "not all zero")),
    ("tide on a top", _torque("kind = 'gravity_gradient'\nmean_motion = 0.001", TOP),
     ("torque[0].kind", "center_of_mass")),
    ("formula calls Python", _formula("\"__import__('os')\""), ("torque[0].torque[2]", "__import__")),
    ("formula of an unknown name", _formula("'-kk*omega_1'"), ("torque[0].torque[2]", "'kk' has no number", "'k'")),
    ("formula of a function", _formula("'gamma(t)'"), ("torque[0].torque[2]", "'gamma'", "sin")),
    ("formula of an attribute", _formula("'t.real'"), ("torque[0].torque[2]", "position 2")),
    ("formula of brackets", _formula(f"'{'(' * 1500}'"), ("torque[0].torque[2]", "nested")),
    ("formula of a long sum", _formula(f"'{'t+' * 900}t'"), ("torque[0].torque[2]", "levels")),
    ("formula of 10 kB", _formula(f"'{'t' * 10_000}'"), ("torque[0].torque[2]", "2000")),
    ("formula nan", _formula("nan"), ("torque[0].torque[2]", "got nan")),
    ("two formulas", _torque("kind = 'expression'\ntorque = ['t', 't']"), ("torque[0].torque", "three formulas")),
    ("parameter named t", _torque("kind = 'expression'\ntorque = [0, 0, 't']\nparameters = {t = 1}"),
     ("torque[0].parameters.t", "'t'")),
    ("parameter is text", _torque("kind = 'expression'\ntorque = [0, 0, 'k']\nparameters = {k = 'x'}"),
     ("torque[0].parameters.k", "'x'")),
    ("frame", _torque("kind = 'expression'\ntorque = [0, 0, 't']\nframe = 'world'"), ("torque[0].frame", "'world'")),
    # span, output, accuracy
    ("span of one time", {"span": "[span]\nt = 20"}, ("span.t", "[start, stop]", "got 20")),
    ("span without t", {"span": "[span]\nsamples = 5"}, ("span.t", "missing")),
    ("reversed span", {"span": "[span]\nt = [20, 0]"}, ("span.t", "start before stop", "[20, 0]")),
    ("span of no length", {"span": "[span]\nt = [2, 2]"}, ("span.t", "positive length", "[2, 2]")),
    ("span nan", {"span": "[span]\nt = [0, nan]"}, ("span.t[1]", "got nan")),
    ("span as text", {"span": "[span]\nt = [0, '20 s']"}, ("span.t[1]", "'20 s'", "unit")),
    ("samples 0", {"span": SPAN.replace("11", "0")}, ("span.samples", "from 2", "got 0")),
    ("samples 1", {"span": SPAN.replace("11", "1")}, ("span.samples", "from 2", "got 1")),
    ("samples 1e12", {"span": SPAN.replace("11", "1e12")}, ("span.samples", "10000000", "1e+12")),
    ("samples 2.5", {"span": SPAN.replace("11", "2.5")}, ("span.samples", "whole", "2.5")),
    ("samples -5", {"span": SPAN.replace("11", "-5")}, ("span.samples", "from 2", "-5")),
    ("samples true", {"span": SPAN.replace("11", "true")}, ("span.samples", "true")),
    ("unknown quantity", {"output": "[output]\nquantities = ['omge']"}, ("output.quantities[0]", "'omge'", "'omega'")),
    ("quantity twice", {"output": "[output]\nquantities = ['dcm', 'dcm']"}, ("output.quantities[1]", "once", "'dcm'")),
    ("no quantities", {"output": "[output]\nquantities = []"}, ("output.quantities", "list", "[]")),
    ("quantities as text", {"output": "[output]\nquantities = 'omega'"}, ("output.quantities", "list", "'omega'")),
    ("euler without sequence", {"output": "[output]\nquantities = ['euler']"}, ("output.sequence", "missing")),
    ("euler of mixed case", {"output": "[output]\nquantities = ['euler']\nsequence = 'zXz'"},
     ("output.sequence", "'zXz'", "case")),
    ("sequence without euler", {"output": "[output]\nquantities = ['dcm']\nsequence = 'ZXZ'"},
     ("output.sequence", "euler", "'ZXZ'")),
    ("tolerance 0", {"accuracy": "[accuracy]\ntolerance = 0"}, ("accuracy.tolerance", "1e-15", "got 0")),
    ("tolerance -1", {"accuracy": "[accuracy]\ntolerance = -1"}, ("accuracy.tolerance", "1e-15", "got -1")),
    ("tolerance 0.5", {"accuracy": "[accuracy]\ntolerance = 0.5"}, ("accuracy.tolerance", "1e-2", "0.5", "meaningless")),
    ("tolerance 1e-20", {"accuracy": "[accuracy]\ntolerance = 1e-20"}, ("accuracy.tolerance", "1e-20", "double")),
]  # fmt: skip


def bad_scenes() -> list[tuple[str, bytes, tuple[str, ...]]]:
    """Return every bad scene as (name, content of the file, words that the message must contain)."""
    return CONTENTS + [(name, base_scene(**tables).encode(), words) for name, tables, words in CHANGES]
