"""Samples of a motion, and their conversion to rotations of SciPy, data frames of pandas and data sets of xarray."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError, with_hint
from symrot.formula.exact_numbers import show
from symrot.kinematics import conversions
from symrot.results import tables
from symrot.results.labels import About, Labelled, about, labelled
from symrot.scene.scene import Scene
from symrot.scene.tables import QUANTITIES

__all__ = ["MotionSamples", "Samples"]

Floats = NDArray[np.float64]


class Samples(ABC):
    """Angular velocity and attitude of a motion at times ``t``, and quantities computed from these two alone."""

    # shape (m,) for one motion, (n, m) for n motions
    t: Floats

    @property
    @abstractmethod
    def omega(self) -> Floats:
        """Angular velocity, body components, rad/s, shape (..., 3)."""

    @property
    @abstractmethod
    def quaternion(self) -> Floats:
        """Attitude as unit quaternions, scalar first, body to space, shape (..., 4)."""

    @abstractmethod
    def _labelled(self, quantities: Sequence[str] | None = None) -> list[Labelled]:
        """Return the time and the quantities ``quantities`` with their labels, for tables.

        By default (None), the output quantities of the scene, and the derivatives if there are any.
        """

    @property
    @abstractmethod
    def _about(self) -> About:
        """Where the samples come from: scene, method and tolerance; tables carry it as attributes."""

    @cached_property
    def dcm(self) -> Floats:
        """The attitude as direction cosine matrices ``dcm_sb``, body to space, shape (..., 3, 3)."""
        return conversions.quaternion_to_dcm(self.quaternion)

    def euler(self, sequence: str, degrees: bool = False) -> Floats:
        """Return Euler angles in order of application, shape (..., 3), rad or degrees.

        At gimbal lock the third angle is 0.
        """
        return conversions.quaternion_to_euler(self.quaternion, sequence, degrees=degrees)[0]

    def gimbal_lock(self, sequence: str) -> NDArray[np.bool_]:
        """Return, for each sample, whether the Euler angles of ``sequence`` are at gimbal lock, shape (...)."""
        # there only the sum or the difference of the first and the third angle is defined
        return conversions.quaternion_to_euler(self.quaternion, sequence)[1]

    def _to_space(self, vectors_b: Floats) -> Floats:
        vectors_s: Floats = np.einsum("...ij,...j->...i", self.dcm, vectors_b)
        return vectors_s

    @cached_property
    def omega_space(self) -> Floats:
        """Angular velocity, space components, rad/s, shape (..., 3)."""
        return self._to_space(self.omega)

    @cached_property
    def polhode(self) -> Floats:
        """The polhode, the path of omega in the body: the same array as :attr:`omega`."""
        return self.omega

    @cached_property
    def herpolhode(self) -> Floats:
        """The herpolhode, the path of omega in space: the same array as :attr:`omega_space`."""
        return self.omega_space

    @cached_property
    def rotation(self) -> Any:
        """The attitudes, body to space, as one ``scipy.spatial.transform.Rotation``.

        Of n motions with m samples each, the n m rotations follow one another, motion after motion.
        """
        from scipy.spatial.transform import Rotation

        return Rotation.from_quat(self.quaternion.reshape(-1, 4)[:, [1, 2, 3, 0]])

    def to_dataframe(self, quantities: Sequence[str] | None = None) -> Any:
        """Return the samples as a pandas DataFrame: one row for each sample, one column for each component.

        Parameters
        ----------
        quantities : sequence of str, optional
            Names that ``output.quantities`` of a scene may have, such as ``["omega", "energy"]``, and of derivatives,
            such as ``"omega_by_weight"``; default: the output quantities of the scene and any derivatives.

        Returns
        -------
        pandas.DataFrame
            The index is ``t``, s; for an ensemble, ``(trajectory, t)``. ``attrs["units"]``, ``attrs["frames"]`` and
            ``attrs["meanings"]`` describe the columns.

        Raises
        ------
        InputError
            If pandas is not installed (``pip install 'symrot[frames]'``), or if a quantity is not available.
        """
        return tables.dataframe(self._labelled(quantities), self._about)

    def to_xarray(self, quantities: Sequence[str] | None = None) -> Any:
        """Return the samples as an xarray Dataset: one variable for each quantity.

        Parameters
        ----------
        quantities : sequence of str, optional
            As for :meth:`to_dataframe`.

        Returns
        -------
        xarray.Dataset
            The dimensions are ``time`` and the axes of the quantity, such as ``body_axis``; for an ensemble,
            ``trajectory`` comes first. Each variable has the attributes ``units``, ``long_name`` and ``frame``.

        Raises
        ------
        InputError
            If xarray is not installed (``pip install 'symrot[frames]'``), or if a quantity is not available.
        """
        return tables.dataset(self._labelled(quantities), self._about)


class MotionSamples(Samples):
    """Samples of a motion whose scene is known, with the quantities that its kernel computes."""

    @property
    @abstractmethod
    def scene(self) -> Scene:
        """The scene of the motion: body, torques, initial state and output quantities."""

    @abstractmethod
    def _evaluate(self, *names: str) -> Floats:
        """Return the output quantities ``names``, such as ``"energy"``, at the samples, shape (..., len(names))."""

    @cached_property
    def angular_momentum_body(self) -> Floats:
        """Angular momentum, including that of a rotor, body components, kg m^2/s, shape (..., 3)."""
        return self._evaluate("momentum_1", "momentum_2", "momentum_3")

    @cached_property
    def angular_momentum_space(self) -> Floats:
        """Angular momentum, including that of a rotor, space components, kg m^2/s, shape (..., 3)."""
        return self._to_space(self.angular_momentum_body)

    @cached_property
    def kinetic_energy(self) -> Floats:
        """Kinetic energy in J, shape (...)."""
        return self._evaluate("kinetic_energy")[..., 0]

    @cached_property
    def energy(self) -> Floats:
        """Kinetic energy plus the potential energy of all torques that have a potential, in J, shape (...)."""
        return self._evaluate("energy")[..., 0]

    @property
    def axis_number(self) -> int | None:
        """Index, from 0, of the body axis that is :attr:`axis`; None if the symmetry axis is not a body axis."""
        principal = self.scene.body.principal
        if principal.symmetry_axis is None:
            return 2
        return principal.symmetry_axis if principal.given_axes else None

    @cached_property
    def axis(self) -> Floats:
        """Direction of the symmetry axis of the body, space components, shape (..., 3).

        It is the direction of the third body axis if the body has no symmetry axis.
        """
        if self.axis_number is not None:
            return conversions.quaternion_to_axis(self.quaternion, self.axis_number)
        principal = self.scene.body.principal
        axes_b = np.array(principal.axes, dtype=np.float64)
        return self._to_space(axes_b[:, principal.symmetry_axis])

    def _labelled(self, quantities: Sequence[str] | None = None) -> list[Labelled]:
        """Return the time and the quantities ``quantities`` with their labels, for tables.

        By default (None), the output quantities of the scene, and the derivatives if there are any.
        """
        return labelled(self, quantities)

    @property
    def _about(self) -> About:
        """Where the samples come from: scene, method and tolerance; tables carry it as attributes."""
        return about(self)

    def quantity(self, name: str) -> Floats:
        """Return the samples of a quantity by its name in ``output.quantities`` of a scene, such as ``"euler"``."""
        if name == "euler":
            output = self.scene.output
            if output.sequence is None:
                raise InputError(
                    'euler: expected an Euler sequence, such as "ZXZ", as output.sequence of the scene, got none'
                )
            return self.euler(output.sequence, degrees=output.degrees)
        if not isinstance(name, str) or name not in QUANTITIES:
            message = f"quantity: expected one of {', '.join(QUANTITIES)}, got {show(name)}"
            raise InputError(with_hint(message, name, QUANTITIES))
        value: Floats = getattr(self, name)
        return value
