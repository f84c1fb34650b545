"""The machine that runs C in Python obeys the rules of C, and refuses faulty texts."""

from decimal import Decimal
from fractions import Fraction

import pytest

from symrot.certificates.c_machine.machine import Machine
from symrot.certificates.exact_step.law import _Slope
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


def test_an_assignment_with_an_operation_computes_its_address_once():
    text = "int f(void) { int i = 0; int a[2] = {1, 2}; a[i++] += 10; a[i] -= a[0] *= 2; return 1000*i + a[0] - a[1]; }"
    assert Machine(text, float, {}).call("f") == 1000 + 22 + 20


@pytest.mark.parametrize("text", ["*(x - 1)", "x[-1]", "*(x + 1 - 2)", "010"])
def test_an_index_before_an_array_and_an_octal_number_are_refused(text):
    with pytest.raises(CertificateError, match=r"negative|octal"):
        Machine(f"double f(double *x) {{ return {text}; }}", float, {}).call("f", ([1.0, 2.0], 0))


def test_a_result_is_converted_to_the_type_of_its_function():
    """The function ``truncated`` returns 2 for 2.5, and ``half`` a number, of which 1/2 is 0.5."""
    text = (
        "int truncated(double x) { return x; } double half(void) { return 1; } "
        "double f(double x) { return truncated(x) + half()/2; }"
    )
    machine = Machine(text, Fraction, {})
    assert machine.call("f", Fraction(5, 2)) == Fraction(5, 2) and machine.call("truncated", Fraction(-5, 2)) == -2
    assert isinstance(machine.call("half"), Fraction)


def test_a_variable_that_keeps_its_value_is_refused():
    text = "int f(void) { static int calls = 0; calls += 1; return calls; }"
    with pytest.raises(CertificateError, match="from call to call"):
        Machine(text, float, {})
    assert Machine(text.replace("static", "static const").replace("calls += 1;", ""), float, {}).call("f") == 0


@pytest.mark.parametrize(("x", "result"), [(2, 1), (3, 2)])
def test_numbers_with_a_derivative_are_equal_if_their_values_are(x, result):
    machine = Machine(
        "int f(double x) { return (x == 2.0) + 2*(2.0 != x); }",
        lambda value: Decimal(value.numerator) / value.denominator,
        {},
    )
    assert machine.call("f", _Slope(Decimal(x), Decimal(1))) == result
