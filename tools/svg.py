"""A few shapes and words as SVG text: the same drawing gives the same bytes, so that a test can compare them."""

from __future__ import annotations

from html import escape

INK, FAINT, LINE = "#1d2733", "#5b6773", "#d5dbe1"
BLUE, ORANGE, GREEN, PINK, GREY = "#1f6fc4", "#d97a00", "#0c9a72", "#b9559a", "#6b7885"
RED = "#d81f2f"


def tint(color: str, share: float) -> str:
    """The colour mixed with white; `share` in 0..1 is how much of the colour is left."""
    parts = (int(color[k : k + 2], 16) for k in (1, 3, 5))
    return "#" + "".join(f"{round(255 - share * (255 - part)):02x}" for part in parts)


class Drawing:
    """Shapes on white paper, in pixels from the upper left corner."""

    def __init__(self, width: int, height: int, title: str) -> None:
        self._head = (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}" font-family="Helvetica, Arial, sans-serif" role="img">\n'
            f"<title>{escape(title)}</title>\n"
        )
        self._parts: list[str] = []
        self.box(0, 0, width, height, fill="#ffffff", round_=0)

    def box(self, x: float, y: float, w: float, h: float, *, fill: str, edge: str = "none", round_: float = 5) -> None:
        self._parts.append(
            f'<rect x="{x:g}" y="{y:g}" width="{w:g}" height="{h:g}" rx="{round_:g}" fill="{fill}" stroke="{edge}"/>'
        )

    def dot(self, x: float, y: float, radius: float, color: str) -> None:
        self._parts.append(f'<circle cx="{x:g}" cy="{y:g}" r="{radius:g}" fill="{color}"/>')

    def line(
        self, points: list[tuple[float, float]], color: str = LINE, *, arrow: bool = False, dashed: bool = False
    ) -> None:
        path = "M" + " L".join(f"{x:g} {y:g}" for x, y in points)
        dashes = ' stroke-dasharray="4 4"' if dashed else ""
        width = 1.6 if arrow else 1
        self._parts.append(f'<path d="{path}" fill="none" stroke="{color}" stroke-width="{width}"{dashes}/>')
        if arrow:
            self._tip(points[-2], points[-1], color)

    def _tip(self, start: tuple[float, float], end: tuple[float, float], color: str) -> None:
        (x0, y0), (x, y) = start, end
        length = ((x - x0) ** 2 + (y - y0) ** 2) ** 0.5
        dx, dy = (x - x0) / length, (y - y0) / length
        corners = [(x, y)] + [(x - 9 * dx - s * 4.5 * dy, y - 9 * dy + s * 4.5 * dx) for s in (1, -1)]
        self._parts.append(f'<path d="M{" L".join(f"{a:.1f} {b:.1f}" for a, b in corners)} Z" fill="{color}"/>')

    def text(
        self,
        x: float,
        y: float,
        words: str,
        *,
        size: float = 12,
        color: str = INK,
        bold: bool = False,
        anchor: str = "start",
        turned: float = 0,
        mono: bool = False,
    ) -> None:
        weight = ' font-weight="bold"' if bold else ""
        family = ' font-family="Menlo, Consolas, DejaVu Sans Mono, monospace"' if mono else ""
        turn = f' transform="rotate({turned:g} {x:g} {y:g})"' if turned else ""
        self._parts.append(
            f'<text x="{x:g}" y="{y:g}" font-size="{size:g}" fill="{color}" text-anchor="{anchor}"'
            f"{weight}{family}{turn}>{escape(words)}</text>"
        )

    def __str__(self) -> str:
        return self._head + "\n".join(self._parts) + "\n</svg>\n"
