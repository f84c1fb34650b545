"""A short form of the campaign against grading."""

from itertools import islice
from random import Random

import pytest

from tests.campaigns.exercises.grading import mark, right_cases, wrong_cases

ENOUGH = 0.8
"""Share of the errors whose kind is named; the campaign of 1000 reaches 0.9."""


def test_right_answers_in_other_forms_are_right():
    marks = [mark(case) for case in islice(right_cases(Random("default")), 15)]
    assert [result for result in marks if result.outcome != "right"] == []


def test_answers_with_one_error_are_wrong_and_the_error_is_named():
    cases = list(islice(wrong_cases(Random("default")), 10))
    marks = [mark(case) for case in cases]
    assert [result for result in marks if result.outcome == "right"] == []
    assert sum(result.code in case.kinds for result, case in zip(marks, cases, strict=True)) >= ENOUGH * len(cases)


@pytest.mark.campaign
def test_the_campaign():
    cases = list(islice(wrong_cases(Random("campaign")), 300))
    marks = [mark(case) for case in cases]
    assert all(result.outcome != "right" for result in marks)
    assert sum(result.code in case.kinds for result, case in zip(marks, cases, strict=True)) >= 0.9 * len(cases)
