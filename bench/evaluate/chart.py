"""Draws charts of error against size, one panel per volume, with png.py: the standard library cannot draw."""

import math

from png import blank

_GLYPHS = {  # 3 x 5 pixels, a digit for each row, its bits from the left
    "A": "25755", "B": "65656", "C": "34443", "D": "65556", "E": "74647", "F": "74644", "G": "34553", "H": "55755",
    "I": "72227", "J": "11152", "K": "55655", "L": "44447", "M": "57755", "N": "65555", "O": "25552", "P": "65644",
    "Q": "25563", "R": "65655", "S": "34216", "T": "72222", "U": "55557", "V": "55552", "W": "55775", "X": "55255",
    "Y": "55222", "Z": "71247", "0": "75557", "1": "26227", "2": "61247", "3": "71317", "4": "55711", "5": "74617",
    "6": "34757", "7": "71122", "8": "75757", "9": "75716", "%": "51245", ".": "00002", ",": "00024", "-": "00700",
    "_": "00007", "'": "22000", "/": "11244", ":": "02020", " ": "00000"}
_SCALE = 2  # each pixel of a glyph is drawn as 2 x 2 pixels
_ADVANCE = 4 * _SCALE
_BLACK, _GREY = (0, 0, 0), (215, 215, 215)
_WIDTH, _HEIGHT = 300, 220  # of a panel
_LEFT, _TOP, _RIGHT, _BOTTOM = 40, 24, 12, 24  # its margins
_LEGEND = 28
COLORS = ((120, 120, 120), (200, 30, 30), (30, 90, 200), (20, 140, 60), (150, 70, 190), (240, 140, 20))


def error_chart(panels, series, columns=4, share_range=(0.1, 100), db_range=(20, 140)):
    """Returns a Picture. `panels`: title -> series' name -> [(share of dense in percent, dB)]. `series`: names, in
    order of the colours."""
    rows = -(-len(panels) // columns)
    picture = blank(columns * _WIDTH, rows * _HEIGHT + _LEGEND)
    x = _LEFT
    for name, color in zip(series, COLORS):
        _line(picture, (x, _LEGEND // 2), (x + 24, _LEGEND // 2), color, 2)
        _text(picture, x + 32, _LEGEND // 2 - 5, name, _BLACK)
        x += 32 + _ADVANCE * len(name) + 24
    for number, (title, lines) in enumerate(panels.items()):
        corner = (number % columns * _WIDTH, _LEGEND + number // columns * _HEIGHT)
        _panel(picture, corner, title, [(lines.get(name, []), color) for name, color in zip(series, COLORS)],
               share_range, db_range)
    return picture


def _panel(picture, corner, title, lines, share_range, db_range):
    left, top = corner[0] + _LEFT, corner[1] + _TOP
    width, height = _WIDTH - _LEFT - _RIGHT, _HEIGHT - _TOP - _BOTTOM
    low, high = (math.log10(share) for share in share_range)

    def place(share, db):
        return (left + round(width * (math.log10(share) - low) / (high - low)),
                top + round(height * (db_range[1] - db) / (db_range[1] - db_range[0])))

    _text(picture, left, corner[1] + 8, title, _BLACK)
    for db in range(db_range[0], db_range[1] + 1, 20):
        y = place(share_range[0], db)[1]
        _line(picture, (left, y), (left + width, y), _GREY, 1)
        _text(picture, left - 4 - _ADVANCE * 3, y - 5, f"{db:3}", _BLACK)
    for power in range(round(low), round(high) + 1):
        x = place(10.0**power, db_range[0])[0]
        _line(picture, (x, top), (x, top + height), _GREY, 1)
        label = f"{10.0**power:g}%"
        _text(picture, min(x - _ADVANCE * len(label) // 2, left + width - _ADVANCE * len(label) + _RIGHT), top + height + 6,
              label, _BLACK)
    for points, color in lines:
        inside = [place(share, db) for share, db in sorted(points)
                  if share_range[0] <= share <= share_range[1] and db_range[0] <= db <= db_range[1]]
        for start, end in zip(inside, inside[1:]):
            _line(picture, start, end, color, 2)
        for x, y in inside:
            _fill(picture, x - 2, y - 2, 6, 6, color)


def _fill(picture, x, y, width, height, color):
    for row in picture.rows[max(0, y) : max(0, y + height)]:
        row[3 * x : 3 * (x + width)] = bytes(color) * width


def _line(picture, start, end, color, thick):
    steps = max(abs(end[0] - start[0]), abs(end[1] - start[1]), 1)
    for step in range(steps + 1):
        x, y = (round(a + (b - a) * step / steps) for a, b in zip(start, end))
        _fill(picture, x, y, thick, thick, color)


def _text(picture, x, y, text, color):
    for letter in text.upper():
        for row, bits in enumerate(_GLYPHS.get(letter, _GLYPHS["-"])):
            for column in range(3):
                if int(bits) >> (2 - column) & 1:
                    _fill(picture, x + _SCALE * column, y + _SCALE * row, _SCALE, _SCALE, color)
        x += _ADVANCE
