"""Campaigns: long searches for mistakes with random problems whose truth shares no code with symrot; run by hand, not
by pytest.
"""
