"""Order, contexts, tables and decoding of coded values (FORMAT.md, "Coded values"), in plain integers."""

import numpy

SYMBOLS = 16
ESCAPE = SYMBOLS - 1
TOTAL = 4096  # the sum of a table's frequencies
LEVELS = 24
BANDS = 4
TABLES = LEVELS * (BANDS + 1)
MOST_MAGNITUDE = 1 << 20  # in a sum of neighbours, larger magnitudes count as this
NONE = 512  # the index of a neighbour that does not exist
LOWEST_STATE = 1 << 16  # the lowest value of a state before and after each step


class Invalid(ValueError):
    """The stream or the packed data does not follow the specification."""


def index(i, j, k):
    return i << 6 | j << 3 | k


def scan_order():
    """Returns (i, j, k) for each place."""
    every = [(i, j, k) for i in range(8) for j in range(8) for k in range(8)]
    shell = [0, 0, 1, 1, 2, 2, 2, 2]
    return sorted(every, key=lambda p: (shell[max(p)], sum(p), index(*p)))


def neighbours(place, order):
    """Returns the indices of the coefficients on which the level at `place` depends."""
    i, j, k = order[place]
    if i + j + k == 1:
        return [index(*order[p]) for p in range(1, place)]
    return [index(*p) for p in ((i - 1, j, k), (i, j - 1, k), (i, j, k - 1)) if min(p) >= 0]


def band(i, j, k):
    return sum(i + j + k >= limit for limit in (2, 6, 10))


def level(t):
    """Returns floor(3 log2(1 + 4 t / 6)), at most 23, in integers: the largest l with 2^l <= ((3 + 2 t) / 3)^3."""
    return min(LEVELS - 1, ((3 + 2 * t) ** 3 // 27).bit_length() - 1)


def extra_bits(t):
    """Returns how many of a magnitude's lowest bits are stored uncoded."""
    return 0 if t <= 36 else min(16, (t // 18).bit_length() - 1)


def make_places():
    """Returns for each place: its index, three neighbours' indices (NONE if missing), 6 / their number, its band."""
    order, places = scan_order(), []
    for place, at in enumerate(order):
        near = neighbours(place, order) if place else []
        weight = 6 // len(near) if near else 0
        places.append((index(*at), *near, *[NONE] * (3 - len(near)), weight, band(*at)))
    return places


PLACES = make_places()
LEVEL = [level(t) for t in range(321)]  # a larger t has the last level


class Tables:
    """Cumulative frequencies [TABLES, SYMBOLS], and the symbol of each of the 4096 slots of each table."""

    def __init__(self, cumulative):
        table = numpy.asarray(cumulative, numpy.int64).reshape(TABLES, SYMBOLS)
        widths = numpy.diff(table, axis=1, append=TOTAL)
        if table[:, 0].any() or (widths <= 0).any():
            raise Invalid("a table of frequencies does not rise from 0 to below 4096")
        self.first = table.tolist()
        self.frequency = widths.tolist()
        symbols = numpy.arange(SYMBOLS, dtype=numpy.uint8)
        self.symbol = [bytes(numpy.repeat(symbols, width)) for width in widths]


class BitReader:
    """Reads bits of `stream` from byte `at` on, the lowest bit of each byte first."""

    def __init__(self, stream, at):
        self.bits = int.from_bytes(stream[at:], "little")
        self.left = 8 * (len(stream) - at)
        self.at = at
        self.read = 0

    def take(self, count):
        if count > self.left:
            raise Invalid("the stream ends in its front bits")
        value = self.bits & ((1 << count) - 1)
        self.bits >>= count
        self.left -= count
        self.read += count
        return value

    def end(self):
        """Returns the position of the first byte after the bits that were read."""
        return self.at + (self.read + 7) // 8


class States:
    """One or two decoder states at the end of a stream, and the words before them, which all states share."""

    def __init__(self, stream, short):
        self.stream = stream
        self.at = len(stream)
        self.x = []
        for is_short in short:
            size = 3 if is_short else 4
            if self.at < size:
                raise Invalid("the stream is shorter than its states")
            self.at -= size
            self.x.append(int.from_bytes(stream[self.at:self.at + size], "little"))

    def renormalised(self, x):
        if x >= LOWEST_STATE:
            return x
        if self.at < 2:
            raise Invalid("words reach the start of the stream")
        self.at -= 2
        return x << 16 | self.stream[self.at] | self.stream[self.at + 1] << 8

    def symbol(self, state, tables, context):
        x = self.x[state]
        slot = x & (TOTAL - 1)
        y = tables.symbol[context][slot]
        self.x[state] = self.renormalised(
            tables.frequency[context][y] * (x >> 12) + slot - tables.first[context][y])
        return y

    def bypass(self, state, count):
        if count == 0:
            return 0
        low = min(count, 16)
        x = self.x[state]
        value = x & ((1 << low) - 1)
        self.x[state] = self.renormalised(x >> low)
        return value | self.bypass(state, count - low) << low if count > low else value


def decode_magnitudes(states, tables, end, banded):
    """Returns the magnitudes of the first 16 `end` places by index. `banded`: of a transform, not of residuals."""
    magnitudes, capped = [0] * 512, [0] * 513
    count = len(states.x)
    symbol, bypass = states.symbol, states.bypass
    for place in range(1, 16 * end):
        at, a, b, c, weight, its_band = PLACES[place]
        t = weight * (capped[a] + capped[b] + capped[c])
        context = LEVELS * (its_band if banded else BANDS) + (LEVEL[t] if t <= 320 else LEVELS - 1)
        state = place % count
        m = symbol(state, tables, context)
        if m == ESCAPE:
            length = bypass(state, 5)
            m = ESCAPE - 1 + (1 << length) + bypass(state, length) & 0xffffffff
        if t > 36:
            k = extra_bits(t)
            if m >> 32 - k:
                raise Invalid("a magnitude has more than 32 bits")
            m = m << k | bypass(state, k)
        if m:
            magnitudes[at] = m
            capped[at] = m if m < MOST_MAGNITUDE else MOST_MAGNITUDE
    return magnitudes


def decode_coefficients(stream, front, end, number_bits, tables, banded):
    """Returns the signed numbers by index (512 i32) and the number of `number_bits` bits that is stored between them.
    `front`: a BitReader of the stream after `end`."""
    count = 0 if end == 0 else 1 if end <= 8 else 2
    states = States(stream, [front.take(1) for _ in range(count)])
    numbers = decode_magnitudes(states, tables, end, banded)
    payload = 0
    for state, x in enumerate(states.x):
        if not LOWEST_STATE <= x < 2 * LOWEST_STATE:
            raise Invalid(f"state {state} ends at {x}")
        payload |= (x - LOWEST_STATE) << 16 * state
    nonzero = [at for at, *_ in PLACES[1:16 * end] if numbers[at]]
    inside = min(len(nonzero), 16 * count)
    moved = min(16 * count - inside, number_bits)
    number = front.take(number_bits - moved) << moved | (payload >> inside) & ((1 << moved) - 1)
    before = len(nonzero) - inside
    signs = front.take(before) | (payload & ((1 << inside) - 1)) << before
    if front.end() > states.at:
        raise Invalid("words reach into the front bits")
    for at in nonzero:
        signed = -numbers[at] if signs & 1 else numbers[at]
        numbers[at] = (signed + (1 << 31)) % (1 << 32) - (1 << 31)
        signs >>= 1
    return numbers, number
