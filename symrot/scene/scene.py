"""Scenes: a body, its initial state, its torques and the requested output, read from a TOML file or a dict.

All numbers are exact. This module does not use SymPy.
"""

from collections.abc import Callable, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import symrot
from symrot.dynamics.torque_kinds import TABLE_KIND
from symrot.errors import InputError
from symrot.formula.exact_numbers import read, show
from symrot.scene.body import Body, read_body
from symrot.scene.changes import SceneContent, changed, in_order, present_value, set_last
from symrot.scene.content import Content, plain, toml_text
from symrot.scene.file import SHIPPED, find_scene, read_toml, shipped_names
from symrot.scene.folders import Folders, listed_folders
from symrot.scene.reader import Entry, fail, read_table, table
from symrot.scene.samples import Table, read_samples
from symrot.scene.tables import SCHEMA, TOP, Initial, Output, Span
from symrot.scene.torque import Torque, read_torque

__all__ = ["Scene", "SceneSource", "load_scene", "shipped_scenes"]

MOST_TORQUES = 100


@dataclass(frozen=True, repr=False)
class Scene:
    """A rigid body, its initial state, the torques on it, and the requested output. All numbers are exact.

    Attributes
    ----------
    name, title, source : str
        Short name of the scene, its title, and the source of the problem, such as a textbook.
    path : str or None
        Path of the scene file, or None for a scene from a dict.
    body : Body
        Inertia, kg m^2, in the axes in which it was given.
    initial : Initial
        Angular velocity, rad/s, body components, and attitude.
    torques : tuple of Torque
        The torques given by formulas.
    span : Span
        Sample times, s.
    output : Output
        The quantities to write.
    tolerance : Fraction
        Error of the trajectory to aim for, in rad for the attitude and relative to its size for the angular velocity.
    table : Table or None
        A torque given by samples, which acts in addition to ``torques``.

    Examples
    --------
    >>> import symrot
    >>> scene = symrot.load_scene("tumbling_prism")
    >>> scene.name
    'tumbling_prism'
    """

    name: str
    path: str | None
    title: str
    source: str
    body: Body
    initial: Initial
    torques: tuple[Torque, ...]
    span: Span
    output: Output
    tolerance: Fraction
    table: Table | None = None  # a torque given by samples, in addition to the torques given by formulas
    origin: "_Origin | None" = field(default=None, compare=False, repr=False)

    def __repr__(self) -> str:
        return f"<Scene {self.name}: {self.title}, {float(self.span.start):g} to {float(self.span.stop):g} s>"

    def _repr_html_(self) -> str:
        return symrot.in_notebook(self)

    @property
    def torque_kinds(self) -> tuple[str, ...]:
        """The kinds of all torques, such as ``("gravity", "table")``; the kind of a torque given by samples is last."""
        table = () if self.table is None else (self.table.kind,)
        return (*(torque.kind for torque in self.torques), *table)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences about possible mistakes in the scene; empty if there are none.

        They concern holes that may reach out of the body, polygons of a mesh that are not flat, and parameters that no
        formula uses.
        """
        return (*self.body.warnings, *(warning for torque in self.torques for warning in torque.warnings))

    @classmethod
    def from_dict(
        cls, content: Mapping[str, Any], where: str = "scene", *, table_folders: str | Path | Sequence[str | Path] = ()
    ) -> "Scene":
        """Return the scene that a dict with the keys of a scene file describes.

        Parameters
        ----------
        content : mapping
            Keys and values as in ``docs/scene_format.md``; numbers may be int, Fraction, Decimal, text, or float (which
            stands for its exact binary value).
        where : str
            Name of the scene; every error message begins with this name.
        table_folders : str, Path or sequence of them
            Folders, in addition to the current folder, whose files a torque of kind table or a mesh may name.

        Raises
        ------
        InputError
            If the content is not a valid scene; the message names key, expectation and value.
        """
        return _read_scene(plain(content, where), where, where, None, table_folders)

    @classmethod
    def build(cls, *, name: str = "scene", **tables: Any) -> "Scene":
        """Return the scene with the given tables; each keyword argument is a table or key of a scene file.

        Parameters
        ----------
        name : str
            Short name of the scene.
        **tables
            ``body``, ``initial`` and ``span``, and optionally ``torque`` (a list), ``output``, ``accuracy``, ``title``
            and ``source``, with the content of ``docs/scene_format.md``. Vectors and tensors may be NumPy arrays, and
            an attitude may be a rotation of SciPy.

        Raises
        ------
        InputError
            If a table is missing, unknown or not valid; the message names key, expectation and value.

        Examples
        --------
        >>> import symrot
        >>> scene = symrot.Scene.build(
        ...     body={"shape": "box", "a": 0.2, "b": 0.13, "c": 0.03, "mass": 0.5},
        ...     initial={"omega": [0.05, 8, 0.02]},
        ...     span={"t": [0, 10]},
        ... )
        >>> scene.body.mass
        Fraction(1, 2)
        """
        return cls.from_dict({"schema": SCHEMA, **tables}, name)

    def to_dict(self) -> dict[str, Any]:
        """Return the content of the scene file or dict from which the scene was read, with all changes since then.

        The result is a copy. It has neither the name nor the path of the scene: ``Scene.from_dict`` reads from it a
        scene that equals this one except for name and path, and for the title if that was derived from the name.
        ``Scene.from_dict`` looks for files of meshes and samples in the current folder.

        Raises
        ------
        InputError
            If the body or the torques were replaced by :func:`dataclasses.replace`, which does not change the content.

        Examples
        --------
        >>> import symrot
        >>> symrot.load_scene("t_handle").with_(omega=[0, 1, 0]).to_dict()["initial"]["omega"]
        [0, 1, 0]
        """
        return deepcopy(self._content())

    def to_toml(self) -> str:
        """Return the scene as the text of a scene file; all numbers keep their exact values.

        Raises
        ------
        InputError
            As for :meth:`to_dict`.

        Examples
        --------
        >>> import symrot
        >>> text = symrot.load_scene("t_handle").with_(samples=11).to_toml()
        >>> "samples = 11" in text
        True
        """
        return toml_text(self._content())

    def with_(self, changes: Mapping[str, Any] | None = None, /, **values: Any) -> "Scene":
        """Return the scene with other values; everything that follows from them is computed again.

        Parameters
        ----------
        changes : mapping, optional
            Key -> value. A key is a path in the scene file, such as ``"body.mass"``, ``"torque[0].weight"`` or
            ``"initial"``, or a short name:

            - ``omega`` (rad/s, body components), ``omega_2``, ``omega_space``;
            - ``attitude``: a quaternion, scalar first, a 3x3 matrix ``dcm_sb``, a rotation of SciPy, a pair such as
              ``("ZXZ", [0.1, 0.2, 0.3])``, or a table;
            - ``t`` ([start, stop], s), ``samples``, ``tolerance``, ``quantities``;
            - ``principal`` and ``I_xx`` to ``I_yz``, kg m^2;
            - the constants of torques, as in :func:`symrot.propagate_ensemble`;
            - the mass, density and dimensions of a body that is one shape.
        **values
            More keys, where the key is a Python name: ``scene.with_(omega=[0, 1, 0], weight=2)``.

        Raises
        ------
        InputError
            If a key names nothing in the scene, if two keys set one value or exclude each other, as mass and density,
            or if the new scene is not valid.

        Examples
        --------
        >>> import symrot
        >>> scene = symrot.load_scene("tumbling_prism")
        >>> scene.with_({"body.mass": 2}, omega_3="1/3").initial.omega_b[2]
        Fraction(1, 3)
        """
        if changes is not None and not isinstance(changes, Mapping):
            raise InputError(f"expected a dict of new values by name, got {show(changes)}")
        every = {**(changes or {}), **values}
        if len(every) > 1:
            every = in_order(self._present(), every)
        last = {key: value for key, value in every.items() if set_last(key)}
        first = {key: value for key, value in every.items() if key not in last}
        shaped = self._changed(first) if first or not last else self
        return shaped._changed(last) if last else shaped

    def value(self, key: str) -> Any:
        """Return the present value that a key of :meth:`with_` names: an exact number, a list, or other content.

        Raises
        ------
        InputError
            If the key names nothing in the scene, or a value that the scene does not give.

        Examples
        --------
        >>> import symrot
        >>> symrot.load_scene("t_handle").value("omega_2")
        Fraction(0, 1)
        """
        value = present_value(self._present(), key)
        try:
            return read(value)
        except InputError:
            return deepcopy(value)

    def _changed(self, changes: Mapping[str, Any]) -> "Scene":
        content = changed(self._present(), changes)
        assert self.origin is not None
        return _read_scene(content, self.origin.label, self.name, self.path, self.origin.table_folders)

    def _present(self) -> SceneContent:
        return SceneContent(self._content(), self.initial.omega_b, self.body, self.torques)

    def _content(self) -> Content:
        """Return the present content of the scene file, from which the scene could be read again.

        If the body or the torques were replaced after reading, raise InputError: they cannot be written back.
        """
        if self.origin is None or not all(
            one is other for one, other in zip(self.origin.parts, _parts(self), strict=True)
        ):
            raise InputError(
                f"{self.name}: expected a scene with the body and torques that were read, got one in which they were "
                "replaced afterwards; write scene.with_(...) instead of dataclasses.replace"
            )
        first = self.origin.scene_values
        replaced = {key: _WRITERS[key](now) for key, now in _values(self).items() if now is not first[key]}
        return {**self.origin.content, **replaced}


class _Origin(NamedTuple):
    """The content from which a scene was read, and the objects (body, torques, ..) that were made from it.

    :meth:`Scene.to_dict` compares these objects with the scene's present ones, to see which were replaced later.
    """

    content: Content
    label: str
    table_folders: str | Path | Sequence[str | Path]
    parts: tuple[Any, ...]
    scene_values: Mapping[str, Any]


def _parts(scene: Scene) -> tuple[Any, ...]:
    """Return the body, the torques and the table of samples of a scene, which :meth:`Scene.to_dict` cannot write.

    :meth:`Scene.to_dict` returns the content of the scene file instead. It can do so only while the scene still has the
    objects that were read from the file: it compares the result of this function with the result just after reading,
    and raises InputError if an object was replaced in between.
    """
    return scene.body, scene.torques, scene.table


def _values(scene: Scene) -> dict[str, Any]:
    """Return title, source, initial state, span, output and tolerance of a scene, by their keys in the scene file.

    :meth:`Scene.to_dict` writes these present values, which may have been replaced after reading.
    """
    return {
        "title": scene.title, "source": scene.source, "initial": scene.initial, "span": scene.span,
        "output": scene.output, "accuracy": scene.tolerance,
    }  # fmt: skip


def _output_content(output: Output) -> Content:
    euler = {"sequence": output.sequence, "degrees": output.degrees} if "euler" in output.quantities else {}
    return {"quantities": list(output.quantities), **euler}


_WRITERS: dict[str, Callable[[Any], Any]] = {
    "title": str,
    "source": str,
    "initial": lambda initial: {
        "omega": list(initial.omega_b), "attitude": {"quaternion": list(initial.quaternion)},
    },
    "span": lambda span: {"t": [span.start, span.stop], "samples": span.samples},
    "output": _output_content,
    "accuracy": lambda tolerance: {"tolerance": tolerance},
}  # fmt: skip
"""Key of a scene file -> function that converts the scene's value to the file's content."""


SceneSource = Scene | Mapping[str, Any] | str | Path
"""What every function accepts as a scene: a scene, the content of a file as a dict, a shipped name, or a path."""


def load_scene(source: SceneSource, *, table_folders: str | Path | Sequence[str | Path] = ()) -> Scene:
    """Return a shipped scene by its name, a scene from the path of a TOML file, or one from a dict.

    Parameters
    ----------
    source : str, Path, mapping or Scene
        Name of a shipped scene, path of a file, or the content of a file as for :meth:`Scene.from_dict`. A scene is
        returned unchanged.
    table_folders : str, Path or sequence of them
        Folders, in addition to the folder of the scene, whose files a torque of kind table or a mesh may name.

    Returns
    -------
    Scene
        The scene, with exact numbers in SI units.

    Raises
    ------
    InputError
        If there is no such scene or file, or if it is not a valid scene; the message then names file, key, expectation
        and value.

    Notes
    -----
    The format: ``docs/scene_format.md``.

    Examples
    --------
    >>> load_scene("tumbling_prism").body.principal.moments
    (Fraction(5, 1), Fraction(20, 1), Fraction(17, 1))
    """
    if isinstance(source, Scene):
        return source
    if isinstance(source, Mapping):
        return Scene.from_dict(source, table_folders=table_folders)
    path = find_scene(source)
    label = path.name if path.parent == SHIPPED else str(source)
    return _read_scene(read_toml(path, label), label, path.stem, str(path), table_folders)


def shipped_scenes() -> list[tuple[str, str, str]]:
    """Return the name, the title and the source of every scene that comes with symrot.

    The rest of the scene files, such as bodies and torques, is not checked here.

    Returns
    -------
    list of (str, str, str)
        (name, title, source); a name is accepted wherever a scene is expected.

    Examples
    --------
    >>> import symrot
    >>> "t_handle" in [name for name, title, source in symrot.shipped_scenes()]
    True
    """
    contents = [(name, read_toml(SHIPPED / f"{name}.toml", name)) for name in shipped_names()]
    return [(name, content.get("title", ""), content.get("source", "")) for name, content in contents]


def _read_torques(
    value: Any, body: Body, span: Span, folder: Path, where: str, table_folders: str | Path | Sequence[str | Path]
) -> tuple[tuple[Torque, ...], Table | None]:
    if not isinstance(value, list | tuple):
        fail(where, "a list of torques, each written as [[torque]]", value)
    if len(value) > MOST_TORQUES:
        fail(where, f"at most {MOST_TORQUES} torques", len(value))
    word = TABLE_KIND.kind
    tables = [index for index, item in enumerate(value) if isinstance(item, Mapping) and item.get("kind") == word]
    if len(tables) > 1:
        fail(f"{where}[{tables[1]}].kind", "at most one torque of kind table", word, "add up the samples of the tables")
    formulas = [read_torque(value[i], body, f"{where}[{i}]") for i in range(len(value)) if i not in tables]
    times = span.start, span.stop
    samples = [read_samples(value[i], folder, f"{where}[{i}]", times, table_folders) for i in tables]
    return tuple(formulas), next(iter(samples), None)


def _read_scene(
    content: Mapping[str, Any],
    label: str,
    name: str,
    path: str | None,
    table_folders: str | Path | Sequence[str | Path],
) -> Scene:
    where = f"{label}: "
    table(content, where, "a table with schema, body, initial, span")
    folder = Path() if path is None else Path(path).parent
    table_folders = listed_folders(table_folders)
    folders = Folders(folder, table_folders)
    body = Entry(lambda value, place: read_body(value, place, folders), required=True)
    values = read_table(content, where, {**TOP, "body": body}, "a scene")
    torques, samples = _read_torques(
        values["torque"], values["body"], values["span"], folder, f"{where}torque", table_folders
    )
    scene = Scene(
        name=name,
        path=path,
        title=values["title"] or name.replace("_", " "),
        source=values["source"],
        body=values["body"],
        initial=values["initial"],
        torques=torques,
        span=values["span"],
        output=values["output"],
        tolerance=values["accuracy"],
        table=samples,
    )
    return replace(scene, origin=_Origin(dict(content), label, table_folders, _parts(scene), _values(scene)))
