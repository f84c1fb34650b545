"""Build step: cut the subset of a mathematical font that the pages of derivations need.

Run it where fonttools, brotli and the font STIX Math are installed (Debian: ``apt install fonts-stix``)::

    python .ci/math_font.py /usr/share/fonts/opentype/stix-word/STIXMath-Regular.otf

It writes ``math.woff2`` and ``characters.txt``, the same bytes each time. The sources were STIX Math
1.1.1 and fonttools 4.
"""

import sys
from pathlib import Path

from fontTools.subset import Options, Subsetter
from fontTools.ttLib import TTFont

FOLDER = Path(__file__).parents[1] / "symrot" / "proof" / "pages" / "font"
NAME = "symrot math"  # the licence reserves the name of the original

RANGES = (
    (0x20, 0x7E),  # letters, digits, signs
    (0x391, 0x3C9), (0x3D1, 0x3F5),  # Greek
    (0x1D434, 0x1D467), (0x1D6E2, 0x1D71B),  # italic letters, as one-letter identifiers are shown
    (0x1D400, 0x1D433), (0x1D7CE, 0x1D7D7), (0x1D5A0, 0x1D5B9),  # bold letters and digits, sans-serif capitals
)  # fmt: skip
SIGNS = (
    "\u00a0\u00a8\u00ac\u00af\u00b1\u00b7\u00d7\u00f7\u02c6\u02d9\u02dc\u0302\u0303\u0304"
    "\u0305\u0307\u0308\u20d7\u203e\u2016\u2026\u2032\u2033\u2034\u210e\u2110\u2113\u2112\u210b"
    "\u211b\u2130\u2131\u2133\u2190\u2192\u21d2\u21a6\u2202\u2207\u2208\u220f\u2211\u2212"
    "\u2213\u2215\u2217\u2218\u221a\u221e\u2220\u2223\u2225\u222b\u222e\u223c\u2248\u2260"
    "\u2261\u2264\u2265\u226a\u226b\u22a5\u22c5\u22c6\u22ef\u27e8\u27e9\u239b\u239c\u239d"
    "\u239e\u239f\u23a0\u23a1\u23a2\u23a3\u23a4\u23a5\u23a6\u23a7\u23a8\u23a9\u23aa\u23ab"
    "\u23ac\u23ad\u23b7\u2061"
)
ASCENT, DESCENT = 750, 250  # of a line of text, thousandths of the size
EXTENDER = 1  # the flag of a part of a tall bracket that is repeated


def main(source: str) -> None:
    """Write the subset of a font file."""
    font = TTFont(source, recalcTimestamp=False)
    options = Options(layout_features=["*"], hinting=False, desubroutinize=True, notdef_outline=True, name_IDs=[])
    options.flavor = "woff2"
    subsetter = Subsetter(options)
    characters = {code for low, high in RANGES for code in range(low, high + 1)} | set(map(ord, SIGNS))
    subsetter.populate(unicodes=characters)
    subsetter.subset(font)
    for number in (1, 4, 6):
        font["name"].setName(NAME if number != 6 else NAME.replace(" ", "-"), number, 3, 1, 0x409)
    # the original's line is as high as its tallest bracket, 3.1 em, and Firefox makes each row of a matrix so high
    header, metrics = font["hhea"], font["OS/2"]
    header.ascent = metrics.sTypoAscender = metrics.usWinAscent = ASCENT
    header.descent = metrics.sTypoDescender = -DESCENT
    metrics.usWinDescent = DESCENT
    header.lineGap = metrics.sTypoLineGap = 0
    # an extender overlaps itself; the original's bars are said not to, and Chromium then does not stretch them
    for glyph in font["MATH"].table.MathVariants.VertGlyphConstruction:
        for part in glyph.GlyphAssembly.PartRecords if glyph.GlyphAssembly else ():
            if part.PartFlags & EXTENDER and not part.EndConnectorLength:
                part.EndConnectorLength = part.StartConnectorLength
    font["CFF "].cff.fontNames[0] = NAME.replace(" ", "-")
    font.flavor = "woff2"
    font.save(FOLDER / "math.woff2", reorderTables=True)
    (FOLDER / "characters.txt").write_text("\n".join(f"{code:04X}" for code in sorted(font.getBestCmap())) + "\n")


if __name__ == "__main__":
    main(sys.argv[1])
