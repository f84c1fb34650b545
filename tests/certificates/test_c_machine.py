"""The machine that runs C in Python chooses the branches of ``#if`` as C does, and refuses faulty texts."""

import pytest

from symrot.certificates.c_machine.machine import Machine
from symrot.errors import CertificateError


@pytest.mark.parametrize(
    ("defined", "branch"), [("A", 1), ("B", 2), ("A\n#define B", 1), ("B\n#define C", 2), ("C", 3), ("D", 4)]
)
def test_the_first_branch_whose_condition_holds_is_used(defined, branch):
    text = (
        f"#define {defined}\nint f(void) {{\n#if defined(A)\nreturn 1;\n#elif defined(B)\nreturn 2;\n"
        "#elif defined(C)\nreturn 3;\n#else\nreturn 4;\n#endif\n}\n"
    )
    assert Machine(text, float, {}).call("f") == branch


@pytest.mark.parametrize(
    "text", ["#endif\nint x;", "#else\nint x;", "#define F(a, b) a + b\ndouble f(double x) { return F(x); }"]
)
def test_a_faulty_preprocessor_line_is_refused(text):
    with pytest.raises(CertificateError, match="expected"):
        Machine(text, float, {})
