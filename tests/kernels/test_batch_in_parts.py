"""A batch function split into several loops over the same samples is read as one kernel, or refused."""

import pytest

from symrot.certificates.readback.readback import read_batch, read_kernel
from symrot.errors import CertificateError

TEXT = """
void pair(const double a[2], double sum[1], double product[1])
{
    const double a1 = a[0];
    const double a2 = a[1];
    sum[0] = a1 + a2;
    product[0] = a1*a2;
}

void pair_batch(size_t n, const double *SYMROT_RESTRICT a, double *SYMROT_RESTRICT sum,
    double *SYMROT_RESTRICT product)
{
    for (size_t start = 0; start < n; start += SYMROT_SPAN) {
        const size_t end = n - start < SYMROT_SPAN ? n : start + SYMROT_SPAN;
        SYMROT_INDEPENDENT
        for (size_t k = start; k < end; ++k) {
            const double a1 = a[0*n + k];
            const double a2 = a[1*n + k];
            sum[0*n + k] = a1 + a2;
        }
        SYMROT_INDEPENDENT
        for (size_t k = start; k < end; ++k) {
            const double a1 = a[0*n + k];
            const double a2 = a[1*n + k];
            product[0*n + k] = a1*a2;
        }
    }
}
"""


def test_the_loops_together_are_the_kernel():
    assert read_batch(TEXT, "pair_batch").digest() == read_kernel(TEXT, "pair").digest()


@pytest.mark.parametrize(
    "old, new",
    [
        ("product[0*n + k]", "sum[0*n + k]"),  # an output of the loop before, and one without a value
        ("start += SYMROT_SPAN", "start += SYMROT_BLOCK"),  # samples left out
        ("? n : start + SYMROT_SPAN", "? n : start + SYMROT_BLOCK"),
        ("k < end; ++k) {\n            const double a1 = a[0*n + k];\n            const double a2 = a[1*n + k];\n"
         "            product", "k < n; ++k) {\n            const double a1 = a[0*n + k];\n"
         "            const double a2 = a[1*n + k];\n            product"),
        ("            const double a2 = a[1*n + k];\n            product", "            product"),  # a name of a loop before
        ("size_t k = start", "size_t k = 0"),
    ],
)  # fmt: skip
def test_another_text_is_refused(old, new):
    assert old in TEXT
    with pytest.raises(CertificateError, match="expected"):
        read_batch(TEXT.replace(old, new), "pair_batch")


@pytest.mark.parametrize("new", ["sum[0*n + k] = a1 - a2;", ""])
def test_a_sign_changed_or_an_output_left_out_in_one_loop_is_another_kernel(new):
    wrong = TEXT.replace("sum[0*n + k] = a1 + a2;", new)
    assert read_batch(wrong, "pair_batch").digest() != read_kernel(TEXT, "pair").digest()
