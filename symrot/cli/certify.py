"""The commands of certification: prove, certify, audit, bound, selftest."""

import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path

import symrot
from symrot.cli.output import FAILED, OK, Command, json_option, progress, say, say_json
from symrot.errors import CertificateError, InputError
from symrot.report.layout import one_line

__all__ = ["COMMANDS"]


def _prove(options: Namespace) -> int:
    from symrot.workshop import coq_files as proofs

    written, result = proofs.prove(options.coq, options.check, progress)
    progress("")
    if options.json:
        say_json(proofs.facts(options.coq, written, result))
    else:
        say(proofs.lines(options.coq, result))
    return FAILED if result is not None and not result else OK


def _selftest(options: Namespace) -> int:
    from symrot.certificates.selftest import run_selftest

    report = run_selftest(bits=not options.bounds)
    if options.json:
        say_json(report.facts())
    else:
        say(report.lines())
    return OK if report.passed else FAILED


def _bound(options: Namespace) -> int:
    progress("bounding ..")
    report: symrot.RoundingBounds | symrot.LargestBox
    if options.target is None:
        if options.variable:
            raise InputError(
                "--variable: expected --target X as well; with --target, symrot widens or narrows the ranges of the "
                "inputs, and --variable names those inputs"
            )
        report = symrot.bound(options.kernel, options.box, options.precision)
    else:
        report = symrot.largest_box(
            options.kernel, options.target, options.box, options.precision, variables=options.variable
        )
    progress("")
    say_json(report.data) if options.json else say([str(report)])
    return OK


def _certify(options: Namespace) -> int:
    if options.all:
        from symrot.workshop import certify as certificates

        if options.kernel or options.box or options.no_bounds or options.step:
            raise InputError("certify: expected --all without a KERNEL, --box, --step or --no-bounds "
                             "(see `symrot certify --help`)")  # fmt: skip
        every, written = certificates.certify_all(options.directory, options.objects, progress)
        progress("")
        say_json(every) if options.json else say([*certificates.all_lines(every), *map(str, written)])
        return FAILED if options.objects and certificates.lacks_proof_of_bits(every.values()) else OK
    if not options.kernel:
        raise InputError("certify: expected a KERNEL or --all (see `symrot certify --help`)")
    certificate = symrot.certify(
        options.kernel, options.box, directory=options.directory, objects=options.objects,
        rounding=not options.no_bounds, step=options.step, order=options.order, progress=progress,
    )  # fmt: skip
    progress("")
    say_json(certificate.data) if options.json else say([str(certificate), *map(str, certificate.files)])
    return FAILED if certificate.bits_unproven else OK


def _audit(options: Namespace) -> int:
    try:
        audit = symrot.audit(
            *options.certificates, object_file=options.object, flags=options.flags, rerun_bounds=options.rerun_bounds,
            coq=options.coq, scene=options.scene, progress=progress,
        )  # fmt: skip
    except CertificateError as reason:
        progress("")
        if options.json:
            say_json({"holds": False, "reason": one_line(str(reason))})
        sys.stderr.write(f"symrot: {one_line(str(reason))}\n")
        return FAILED
    progress("")
    if options.json:
        say_json({"holds": True, "certificates": audit.statements} | ({"flags": audit.flags} if audit.flags else {}))
    else:
        say([str(audit)])
    return OK


def _prove_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--coq", type=Path, metavar="DIR", required=True, help="write the theorems as Coq files into this folder"
    )
    parser.add_argument(
        "--check", action="store_true", help="fail if Coq is not installed (default: then only write the files)"
    )
    json_option(parser)


def _selftest_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--bounds",
        action="store_true",
        help="test only what the error bounds assume of the compiler and the processor; a compiler that rounds "
        "a*b + c once instead of twice passes, although its results may differ in the last bits",
    )
    json_option(parser)


def _bound_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "kernel", metavar="KERNEL", help="a kernel of the library (see `symrot emit --list`) or a scene"
    )
    parser.add_argument("--box", metavar="NAME=LOW:HIGH", action="append", default=[],
                        help="range of an input, such as theta=-1.4:1.4 (default: the kernel's own range), or of a "
                        "physical constant of a scene, such as A=1:2; may be repeated")  # fmt: skip
    parser.add_argument(
        "--target", type=float, metavar="X", help="find the largest ranges of inputs for which no error is above X"
    )
    parser.add_argument("--variable", metavar="NAME", action="append", default=[],
                        help="with --target: change the range of this input only; may be repeated")  # fmt: skip
    parser.add_argument(
        "--precision", choices=("double", "float"), default="double", help="type of the numbers (default: double)"
    )
    json_option(parser)


def _certify_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("kernel", metavar="KERNEL", nargs="?",
                        help="a kernel of the library, its C file or certificate, or a scene")  # fmt: skip
    parser.add_argument("--all", action="store_true", help="certify the library and the kernels of all shipped scenes")
    parser.add_argument("--box", metavar="NAME=LOW:HIGH", action="append", default=[],
                        help="range of an input for the bounds of rounding errors, or of a physical constant of a "
                        "scene; may be repeated")  # fmt: skip
    parser.add_argument("--step", metavar="METHOD", help="certify one time step of a scene: rk4, taylor, dop853 or "
                        "exact; with --box for its states and dt, bound rounding and truncation")  # fmt: skip
    parser.add_argument(
        "--order", type=int, metavar="N", help="order of the Taylor series with --step taylor, 1 to 16 (default: 8)"
    )
    parser.add_argument(
        "--objects", action="store_true", help="compile the kernel, and compare the object code with the C text"
    )
    parser.add_argument("--no-bounds", action="store_true", help="omit the bounds of rounding errors")
    parser.add_argument(
        "-o", type=Path, metavar="DIR", dest="directory", help="write the kernel and its certificate into this folder"
    )
    json_option(parser)


def _audit_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("certificates", type=Path, nargs="+", metavar="FILE.cert.json",
                        help="a certificate, in one folder with the files of its kernel")  # fmt: skip
    parser.add_argument(
        "--object", type=Path, metavar="FILE.o", help="check the object file that your compiler made from the C file"
    )
    parser.add_argument(
        "--flags",
        metavar="'CC FLAGS'",
        help="your compiler flags, such as 'gcc -O3 -mfma': print which statements of the certificate still hold with "
        "these flags",
    )
    parser.add_argument(
        "--scene", metavar="SCENE", help="compare the equations and parameters of a kernel or step with this scene"
    )
    parser.add_argument("--rerun-bounds", action="store_true", help="compute the bounds of rounding errors again")
    parser.add_argument("--coq", action="store_true", help="let Coq check the theorem about the kernel")
    json_option(parser)


COMMANDS: dict[str, Command] = {
    "prove": ("print the kinematics as theorems, and have Coq check them", _prove, _prove_arguments),
    "certify": ("certify a kernel: laws, C text, rounding errors, object code", _certify, _certify_arguments),
    "audit": ("check that a certificate holds for the files in its folder", _audit, _audit_arguments),
    "bound": ("bound the rounding errors of a kernel for inputs in given ranges", _bound, _bound_arguments),
    "selftest": ("check that this machine computes as the certificates assume", _selftest, _selftest_arguments),
}
"""Names of the commands -> (help text, function that runs the command, function that declares its arguments)."""
