"""Two line drawings for exercises, as SVG in the colour of the text and with a title for screen readers."""

__all__ = ["crank_and_slider", "hanging_rod"]


def _drawing(title: str, width: int, height: int, *parts: str) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" fill="none" '
        f'stroke="currentColor" stroke-width="2" stroke-linecap="round"><title>{title}</title>{"".join(parts)}</svg>'
    )


def _letter(x: int, y: int, text: str) -> str:
    style = 'font-family="serif" font-style="italic" font-size="16" fill="currentColor" stroke="none"'
    return f'<text x="{x}" y="{y}" {style} text-anchor="middle">{text}</text>'


def _circle(x: int, y: int, radius: int, fill: str = "none") -> str:
    return f'<circle cx="{x}" cy="{y}" r="{radius}" fill="{fill}"/>'


def hanging_rod() -> str:
    """Return an SVG drawing of a rod that hangs from an axis at its upper end, with length and centre marked."""
    return _drawing(
        "A rod that hangs from an axis at its upper end", 160, 200,
        '<path d="M50 22 H110"/><path d="M80 30 L120 170" stroke-width="6"/>',
        '<path d="M80 30 V175" stroke-dasharray="3 5" stroke-width="1"/>',
        _circle(80, 30, 5, "currentColor"), _circle(100, 100, 4, "currentColor"),
        _letter(66, 48, "O"), _letter(117, 98, "C"), _letter(132, 150, "L"),
    )  # fmt: skip


def crank_and_slider() -> str:
    """Return an SVG drawing of a crank, a connecting rod and a piston on a line through the crank's axis."""
    return _drawing(
        "A crank, a connecting rod and a piston", 300, 130,
        '<path d="M10 90 H290" stroke-dasharray="3 5" stroke-width="1"/>',
        '<path d="M60 90 L95 38" stroke-width="4"/><path d="M95 38 L225 90" stroke-width="3"/>',
        '<rect x="225" y="72" width="46" height="36"/><path d="M84 90 A24 24 0 0 0 73 70" stroke-width="1"/>',
        _circle(60, 90, 5, "currentColor"), _circle(95, 38, 4, "currentColor"), _circle(225, 90, 4, "currentColor"),
        _letter(68, 56, "r"), _letter(168, 56, "L"), _letter(96, 82, "φ"),
    )  # fmt: skip
