"""The command that prints kernels as source code: emit."""

import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path

from symrot.cli.output import FAILED, OK, Command, progress, say
from symrot.errors import InputError

__all__ = ["COMMANDS"]

TARGETS = ("c", "numpy", "js", "jax")


def _emit(options: Namespace) -> int:
    from symrot.workshop import kernel_files as kernels

    if sum(map(bool, (options.kernel, options.all, options.check, options.list))) != 1:
        raise InputError("emit: expected exactly one of these: KERNEL (or SCENE), --all, --check, --list "
                         "(see `symrot emit --help`)")  # fmt: skip
    if options.cmake and (options.directory is None or options.target not in (None, "c") or not options.kernel):
        raise InputError("--cmake: expected a KERNEL or SCENE, -o DIR and no --target other than c "
                         "(see `symrot emit --help`)")  # fmt: skip
    for option in ("jacobian", "step", "order"):
        if getattr(options, option) is not None and not options.kernel:
            raise InputError(f"--{option}: expected a KERNEL or SCENE as well (see `symrot emit --help`)")
    if options.list:
        say(kernels.kernel_lines())
        return OK
    targets = (options.target,) if options.target else TARGETS
    if options.check:
        different = kernels.stale(options.directory or Path("generated"), targets, progress)
        progress("")
        say(different)
        return FAILED if different else OK
    if options.all:
        written = kernels.write_all(options.directory or Path("generated"), targets, progress)
    else:
        kernel = kernels.chosen_text(options.kernel, options.jacobian, options.step, options.order)
        bounds = kernels.stored_bounds(kernel, options.directory) if options.target in (None, "c") else None
        texts = kernel.files(options.target or "c", bounds)
        if options.directory is None:
            sys.stdout.write("\n".join(texts.values()))
            return OK
        if options.target in (None, "c"):
            texts |= kernels.certificate_files(kernel, options.directory, bounds)
        if options.cmake:
            texts |= kernels.build_files()
        written = kernels.write_files(options.directory, texts)
    progress("")
    say(str(path) for path in written)
    return OK


def _emit_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("kernel", metavar="KERNEL", nargs="?", help="a kernel of the library, a scene, or a scene file")
    parser.add_argument("--list", action="store_true", help="list the kernels of the library")
    parser.add_argument("--all", action="store_true", help="write the library and the kernels of all shipped scenes")
    parser.add_argument(
        "--check",
        action="store_true",
        help="compare the files on disk with new ones; exit 1 with a diff if they differ",
    )
    parser.add_argument(
        "--target", choices=TARGETS, help="language to emit (default: c for a kernel, all for --all and --check)"
    )
    parser.add_argument("--jacobian", metavar="NAME,..", help="add the derivatives of the outputs with respect "
                        "to these inputs, such as omega,q, or to constants of a scene")  # fmt: skip
    parser.add_argument("--step", metavar="METHOD", help="emit one time step of a scene: rk4, taylor, dop853 or exact")
    parser.add_argument(
        "--order", type=int, metavar="N", help="order of the Taylor series with --step taylor, 1 to 16 (default: 8)"
    )
    parser.add_argument("--cmake", action="store_true", help="with -o: also write the files with which CMake "
                        "and pkg-config find the kernels in this folder")  # fmt: skip
    parser.add_argument("-o", type=Path, metavar="DIR", dest="directory",
                        help="folder to write to, or to compare with --check (default: standard output for a kernel, "
                        "otherwise ./generated)")  # fmt: skip


COMMANDS: dict[str, Command] = {
    "emit": ("print a kernel of the library or of a scene as C, NumPy, JavaScript or JAX", _emit, _emit_arguments),
}
"""Name of the command -> (help text, function that runs it, function that declares its arguments)."""
