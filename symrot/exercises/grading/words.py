"""Tables of the messages about wrong answers, with the credit for each kind of error: for numbers and for formulas."""

from fractions import Fraction

__all__ = ["FORMULA_FAULTS", "NUMBER_FAULTS", "RIGHT", "SLIPS"]

RIGHT = Fraction(1)

NUMBER_FAULTS: dict[str, tuple[Fraction, str]] = {
    "unit_forgotten": (Fraction(4, 5), "the number is right, but its unit is missing: write {unit}"),
    "coarse": (Fraction(1, 2), "the number is rounded too much: give at least three significant digits"),
    "sign": (Fraction(1, 2), "the size is right, but the sign is wrong: check the directions"),
    "factor": (
        Fraction(1, 2),
        "the number is {factor} times the answer: look for a factor that is missing or superfluous",
    ),
    "degrees": (Fraction(1, 2), "degrees and radians are mixed up: work in radians, and convert at the end"),
    "power_of_ten": (Fraction(1, 2), "the number is wrong by a power of ten: check how you converted the units"),
    "inverse": (Fraction(1, 4), "this is the reciprocal of the answer"),
    "slip": (Fraction(1, 2), "{slip}"),
    "turns": (Fraction(1, 2), "revolutions and radians are mixed up: one revolution is 2 pi rad"),
    "dimension": (Fraction(0), "the unit is {own}, but the answer has the unit {unit}"),
    "other": (Fraction(0), "the number is wrong"),
}
"""Kind of error in a number -> credit and sentence."""

SLIPS: dict[str, str] = {
    "diameter": "a diameter is used in place of the radius {}",
    "radius": "a radius is used in place of the diameter {}",
    "degrees": "the angle {} is used in degrees where radians are needed",
    "unconverted": "the unit of {} is not converted",
}
"""Kind of mistake in using a quantity -> sentence, with a place for the symbol of the quantity."""

HALF, QUARTER, NOTHING = Fraction(1, 2), Fraction(1, 4), Fraction(0)

FORMULA_FAULTS: dict[str, tuple[Fraction, str]] = {
    "sign_of_term": (HALF, "one term has the wrong sign"),
    "overall_sign": (HALF, "the whole formula has the wrong sign: check the directions"),
    "factor": (HALF, "a factor is wrong, missing or superfluous"),
    "exponent": (HALF, "a power is wrong: look for a square that is missing"),
    "half_angle": (HALF, "an angle is used where half the angle is needed"),
    "double_half_angle": (HALF, "half an angle is used where the whole angle is needed"),
    "sin_cos_swap": (HALF, "sine and cosine are exchanged"),
    "lost_brackets": (HALF, "brackets are missing"),
    "wrong_symbol": (HALF, "one letter is used in place of another"),
    "missing_term": (HALF, "a term is missing"),
    "extra_term": (HALF, "one term is superfluous"),
    "inertia_product_sign": (HALF, "the products of inertia have the wrong sign"),
    "active_passive_transpose": (HALF, "the rotation is applied in the wrong direction (the matrix is transposed)"),
    "frame_body_space": (HALF, "body components and space components are mixed up"),
    "quaternion_product_order": (HALF, "the factors of the quaternion product are in the wrong order"),
    "commutator_order": (HALF, "the factors of a matrix product are in the wrong order"),
    "exchanged": (HALF, "two letters are exchanged"),
    "letter_missing": (QUARTER, "a letter of the answer is missing"),
    "inverse": (QUARTER, "this is the reciprocal of the answer"),
    "two_faults": (QUARTER, "the formula has two errors"),
    "requires_condition": (HALF, "this holds only in a special case"),
    "unit": (NOTHING, "the units do not agree, so a factor or a power is missing or superfluous"),
    "none": (NOTHING, "the formula is not equal to the answer"),
}
"""Code of an error, mostly the code of the checker's diagnosis -> credit and sentence.

A code that is not in this table gets the credit and the sentence of ``"none"``.
"""
