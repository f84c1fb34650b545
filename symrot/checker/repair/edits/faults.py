"""The faults that occur in practice: the code and the sentence of each diagnosis, and the costs of edits."""

__all__ = ["COST", "FAULT_DESCRIPTIONS"]

FAULT_DESCRIPTIONS = {
    "none": "",
    "frame_body_space": "the body frame and the space frame are exchanged",
    "active_passive_transpose": "a rotation is used in place of its inverse: active for passive, or a transpose",
    "quaternion_product_order": "the factors of a quaternion product are exchanged",
    "quaternion_storage_order": "the components of a quaternion are stored in another order",
    "sign_of_term": "a term has the wrong sign",
    "overall_sign": "a whole side has the wrong sign",
    "commutator_order": "the factors of a matrix product are exchanged",
    "factor": "a factor is wrong, missing or superfluous",
    "exponent": "a power is wrong, such as a square that is missing",
    "half_angle": "an angle is used in place of its half",
    "double_half_angle": "an angle is used in place of its double",
    "sin_cos_swap": "sine and cosine are exchanged",
    "wrong_symbol": "a symbol is used in place of another one",
    "missing_term": "a term is missing",
    "extra_term": "there is a term too many",
    "lost_brackets": "brackets are missing or enclose too little",
    "inertia_product_sign": "the products of inertia have the other sign",
    "wrong_sequence_type": "the rotations belong to another sequence",
    "two_faults": "two things are wrong",
    "requires_unit_norm": "the claim holds for a unit vector or quaternion only",
    "requires_symmetric_top": "the claim holds for equal moments of inertia only",
    "requires_condition": "the claim holds under a condition only",
    "sign_branch": "the claim holds on one branch of a root only",
    "principal_value": "the claim holds for principal values of the inverse function only",
}
"""Code of a fault, as ``Diagnosis.code`` -> the sentence that describes the fault."""

COST = {
    "frame_body_space": 0.55, "active_passive_transpose": 0.6, "quaternion_product_order": 0.6,
    "commutator_order": 0.65, "quaternion_storage_order": 0.7,
    "inertia_product_sign": 0.65, "sign_of_term": 0.8, "overall_sign": 0.75,
    "sin_cos_swap": 1.0, "wrong_symbol": 1.0, "half_angle": 1.05, "double_half_angle": 1.05, "factor": 1.1,
    "two_faults": 1.6, "wrong_sequence_type": 1.2, "extra_term": 1.5, "missing_term": 1.6,
    "lost_brackets": 1.15,
    # added to the cost of the code
    "in_definition": 0.4, "number_off_by_one": 0.15, "name_transposed": 0.02,
    "rows_as_columns": 0.01, "names_exchanged": 0.1, "root_left_out": 0.1,
    "cross_product_order": 0.02, "whole_cross_product_order": -0.04,
    "factor_removed": 0.1, "product_doubled_or_halved": 0.05,
    "quotient_inverted": 0.1, "quaternion_conjugated": 0.05, "sequence_reversed": -0.3, "three_axes_changed": 0.2,
    # one fault everywhere in a tree
    "angle_everywhere": 0.9, "angle_everywhere_often": 1.07, "sin_cos_swap_everywhere": 0.95,
    "transpose_everywhere": 0.58,
    # several wrong entries of a matrix, each with its own edit: times the sum of the costs of these edits
    "share_of_entries": 0.6,
    # additions to a tree
    "missing_term_of_entry": 1.75, "missing_term_in_bracket": 1.8, "missing_matrix": 1.4, "other_definition": 1.3,
    # a part of the claim replaced by a formula with the value that makes the claim true
    "solved_sign": 0.85, "solved_factor_2": 1.16, "solved_rational_factor": 1.3, "solved_number": 1.25,
    "solved_factor": 1.22, "solved_factor_of_number": 0.5, "solved_term_of_sum": 1.5, "solved_term": 1.65,
    "solved_swap": 1.0, "solved_neighbour": 1.0, "solved_symbol": 1.2, "solved_matrix_term": 0.04,
    # a part of a formula near a known one: per factor e between two numbers, a fraction in place of a number, a power
    # other than the square, and a function other than the one that is often confused with it
    "exponent": 1.1, "per_factor_e": 0.1, "no_integer": 0.15, "not_a_square": 0.1, "other_function": 0.1,
    # additions for each part of an inserted formula, and for each level between the whole formula and the edited part
    "per_piece_added": 0.02, "rational_in_front": 0.04, "per_level": 0.01, "per_level_of_matrix": 0.05,
}  # fmt: skip
"""Code of a fault such as ``sign_of_term`` -> the cost of an edit that corrects it; cheaper edits are tried first.

Keys that are not in FAULT_DESCRIPTIONS name special kinds of edits. Some of their values are costs; others are added to
a cost or multiply one, as the comments say.
"""
