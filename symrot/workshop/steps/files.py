"""The C files of a time step: header, source, values of the parameters, test."""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

from symrot.certificates.certificate import KernelUnderTest
from symrot.codegen.printing.parameters_header import parameters_file, parameters_header
from symrot.errors import CertificateError, InputError
from symrot.workshop.kernel_text import Bounds, KernelText

__all__ = ["StepFiles", "constant_table"]


class StepFiles(KernelText):
    """The C files and the certificate of a time step of any method: "rk4", "taylor", "dop853" or "exact"."""

    # comments in the C files state no error bounds; those of rk4 and taylor are in the certificate alone
    folders: ClassVar[Mapping[str, str]] = {}

    @property
    @abstractmethod
    def _source_and_header(self) -> tuple[str, str]: ...

    @property
    @abstractmethod
    def _parameters(self) -> Sequence[tuple[str, float]]:
        """Pairs (name, value), one for each parameter of the scene's equations; empty if the equations have none."""

    @property
    def parameter_values(self) -> tuple[float, ...]:
        """The scene's values of the step's parameters, which the emitted function takes as the array ``p``."""
        return tuple(value for _, value in self._parameters)

    @property
    @abstractmethod
    def _test(self) -> str:
        """The text of a C program that compares the step with the test vectors; it exits with 0 if all agree."""

    def c(self, bounds: Bounds | None = None) -> tuple[str, str]:
        """Return the C source and its header; ``bounds`` must be None, because their comments state no error bounds."""
        if bounds:
            raise InputError(
                f"{self.name}: bounds: expected None, because the C text of a time step states no bounds of errors, "
                "got bounds; `symrot certify SCENE --step METHOD --box NAME=LOW:HIGH` prints them in the certificate"
            )
        return self._source_and_header

    def under_test(self, bounds: Bounds | None = None) -> KernelUnderTest:
        """Raise CertificateError: a step has a certificate of its own kind."""
        raise CertificateError(
            f"{self.name}: expected a kernel of the library or of a scene, got a time step; "
            "`symrot certify SCENE --step METHOD` certifies steps"
        )

    def c_files(self, bounds: Bounds | None = None) -> dict[str, str]:
        """Return the C files as a map from name to text: header, source, values of the parameters, test."""
        values = self._parameters
        parameters = {parameters_file(self.name): parameters_header(self.name, values)} if values else {}
        return super().c_files(bounds) | parameters | {f"{self.name}_test.c": self._test}


def constant_table(declared: str, values: Any) -> str:
    """Return the C definition of a constant table of doubles, such as ``static const double x[2] = {1.0, 2.0};``."""

    def text(value: Any) -> str:
        # ``declared`` is the name with its sizes, "x[2]"; ``values`` are nested lists of numbers
        return f"{{{', '.join(map(text, value))}}}" if isinstance(value, list) else repr(value)

    return f"static const double {declared} = {text(values)};"
