#!/usr/bin/env python3
"""Draws the largest force of each sleeper beside a bridge, a line a run, as SVG.

  scripts/pictures/sleeper-forces.py "0 mm=out/good" "4 mm=out/moderate" "8 mm=out/degraded" > forces.svg

Reads sleepers.csv of each run's folder. Sleepers are counted from the bridge, -1 before it, 1 behind it.
"""
import csv
import pathlib
import sys

REACH = 25                          # sleepers on each side that are drawn
WIDTH, HEIGHT, LEFT, BOTTOM, TOP = 820, 360, 60, 50, 20
GAP = 60                            # for the bridge
COLOURS = ["#4c78a8", "#e6892f", "#c0392b", "#5b8c5a", "#7b5ea7"]


def forces_of(folder):
    """Sleeper number -> largest force [kN], sleepers on the embankments only."""
    with open(pathlib.Path(folder) / "sleepers.csv", newline="") as rows:
        return {int(row["number [-]"]): float(row["peak_force [N]"]) / 1e3
                for row in csv.DictReader(rows) if row["zone"] in ("approach", "departure")}


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    runs = [argument.rpartition("=")[::2] for argument in sys.argv[1:]]
    lines = [(name, forces_of(folder)) for name, folder in runs]
    top = 20 * (1 + max(max(forces.values()) for _, forces in lines) // 20)
    pitch = (WIDTH - LEFT - 20 - GAP) / (2 * REACH - 2)
    middle = LEFT + pitch * (REACH - 1) + GAP / 2

    def x_of(number):
        return middle + (GAP / 2 if number > 0 else -GAP / 2) + pitch * (number - (1 if number > 0 else -1))

    def y_of(force):
        return TOP + (HEIGHT - TOP - BOTTOM) * (1 - force / top)

    def text(x, y, words, anchor="middle", colour="#222"):
        return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{words}</text>'

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
           f'viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
           f'<rect x="{middle - GAP / 2 + 6:.1f}" y="{TOP}" width="{GAP - 12}" '
           f'height="{HEIGHT - TOP - BOTTOM}" fill="#e4e4e4"/>', text(middle, TOP + 16, "bridge")]
    for force in range(0, int(top) + 1, 20):
        y = y_of(force)
        out += [f'<line x1="{LEFT}" x2="{WIDTH - 20}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>',
                text(LEFT - 8, y + 4, str(force), "end")]
    for number in [n for n in range(-REACH, REACH + 1) if n % 5 == 0 and n or abs(n) == 1]:
        out.append(text(x_of(number), HEIGHT - BOTTOM + 18, str(number)))
    out += [text((LEFT + WIDTH) / 2, HEIGHT - 10, "sleeper, counted from the bridge; the train comes from the left"),
            f'<g transform="rotate(-90 16 {HEIGHT / 2})">{text(16, HEIGHT / 2, "largest force on the ballast [kN]")}</g>']
    for k, (name, forces) in enumerate(lines):
        colour = COLOURS[k % len(COLOURS)]
        for side in (-1, 1):
            points = [(x_of(n), y_of(forces[n])) for n in sorted(forces) if n * side > 0 and abs(n) <= REACH]
            out.append(f'<polyline fill="none" stroke="{colour}" stroke-width="1.6" points="'
                       + " ".join(f"{x:.1f},{y:.1f}" for x, y in points) + '"/>')
            out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.4" fill="{colour}"/>' for x, y in points]
        out.append(text(LEFT + 12, TOP + 16 + 16 * k, name, "start", colour))
    print("\n".join(out + ["</svg>"]))


if __name__ == "__main__":
    main()
