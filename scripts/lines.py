# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""The lines that a spectrum of gears can show, by name: an order of the pinion for each.

    mesh k                 teeth meeting, k times the teeth of the pinion
    pinion, wheel          a turn of either gear
    mesh k + n pinion      sidebands: what differs from tooth to tooth and comes again with each turn of a gear
    hunting tooth          the same two teeth meet again: every lcm(z_p, z_w) teeth, order gcd(z_p, z_w) / z_w
    ghost N                teeth of the index wheel of the machine that cut a gear: asked for
    planets ...            of a planetary set with a fixed ring, per turn of the sun
"""
import math
import re
from fractions import Fraction

import indicators
import program
import runup

KINDS = ("mesh", "pinion", "wheel", "hunting", "ghost", "planet", "asked")


class Line:
    def __init__(self, order, name, kind):
        self.order, self.name, self.kind = Fraction(order), name, kind

    @property
    def is_sideband(self):
        return re.search(r" [+-] ", self.name) is not None

    def __repr__(self):
        return f"Line({float(self.order):.6g}, {self.name!r})"


# ----------------------------------------------------------------------------------------------------
# What a run or an option says
# ----------------------------------------------------------------------------------------------------


def add_arguments(parser):
    add = parser.add_argument
    add("--eigenfrequency", type=positive, metavar="HZ", help="line f0 [what the file says]")
    add("--pinion-teeth", type=int, metavar="Z", help="[what the file says]")
    add("--wheel-teeth", type=int, metavar="Z", help="[what the file says]; a ring may have a minus")


def positive(text):
    value = float(text)
    if not 0.0 < value < math.inf:
        raise ValueError(text)
    return value


def eigenfrequency_of(provenance):
    """Eigenfrequency in Hz from the head lines of a run, None if there is none."""
    try:
        frequency_Hz = float(provenance.get("eigenfrequency_Hz", ""))
    except ValueError:
        return None
    return frequency_Hz if 0 < frequency_Hz < math.inf else None


def gears_of(path, provenance, options, needed=True):
    """Gears from options, else from the head lines of a run; None if neither says and they are not needed."""

    def teeth(gear, option):
        text = str(option) if option is not None else provenance.get(f"gears.{gear}_teeth", "")
        if not text and not needed:
            return None
        digits = text.removeprefix("-") if gear == "wheel" else text  # of a ring
        if not (digits.isascii() and digits.isdigit() and 3 <= int(digits[:9]) and len(digits) <= 5):
            if option is not None:
                raise program.InputError(f"--{gear}-teeth: must be 3 to 99999 (got {text})")
            got = f" (got {program.shown(text[:40])})" if text else ""
            other_way = f", or give --{gear}-teeth" if getattr(options, "on_command_line", True) else ""
            raise runup.RunError(f"{path}: its head must have gears.{gear}_teeth, 3 to 99999{got}{other_way}")
        return int(digits)

    pinion, wheel = teeth("pinion", options.pinion_teeth), teeth("wheel", options.wheel_teeth)
    if pinion is None or wheel is None:
        if pinion is not wheel:
            known, other = ("pinion", "wheel") if pinion else ("wheel", "pinion")
            raise program.InputError(f"{path}: has the teeth of the {known} only; please give --{other}-teeth as well")
        return None
    is_ring = options.wheel_teeth is None and provenance["gears.wheel_teeth"].startswith("-")
    return runup.Gears(pinion, wheel, options.eigenfrequency or eigenfrequency_of(provenance), is_ring)


def orders_asked(text, option="--orders"):
    """`45, 22.5, 36*93/129`: numbers, their products and quotients, without rounding."""
    found = []
    for part in text.split(","):
        tokens = re.findall(r"[0-9.]+(?:[eE][+-]?[0-9]+)?|[*/]", part)
        try:
            if "".join(tokens) != "".join(part.split()) or len(tokens) % 2 == 0:
                raise ValueError
            order = Fraction(tokens[0])
            for sign, number in zip(tokens[1::2], tokens[2::2]):
                order = order * Fraction(number) if sign == "*" else order / Fraction(number)
            if not 0 < order <= 10**6:
                raise ValueError
        except (ValueError, ZeroDivisionError):
            raise program.InputError(f"{option}: must be orders > 0 as 45, 22.5 or 36*93/129, with commas between them "
                                     f"(got '{program.shown(part.strip())}')") from None
        found.append(order)
    return list(dict.fromkeys(found))


# ----------------------------------------------------------------------------------------------------
# Lines
# ----------------------------------------------------------------------------------------------------


def of_gears(gears, harmonics, sidebands=indicators.SIDEBANDS):
    """Lines of a pair, each order once: a tooth order is no sideband, a pinion of few teeth has fewer sidebands."""
    found = {}

    def add(order, name, kind):
        line = found.setdefault(Fraction(order), Line(order, name, kind))
        if line.kind in ("pinion", "wheel") and kind in ("pinion", "wheel") and line.kind != kind:
            line.name = f"{line.name} = {name}"

    # Teeth, turns, and the same two teeth.
    turns = {"pinion": Fraction(1), "wheel": Fraction(gears.pinion_teeth, gears.wheel_teeth)}
    for k in range(1, harmonics + 1):
        add(k * gears.pinion_teeth, f"mesh {k}", "mesh")
    for gear, turn in turns.items():
        add(turn, gear, gear)
    hunting = Fraction(math.gcd(gears.pinion_teeth, gears.wheel_teeth), gears.wheel_teeth)
    add(hunting, "hunting tooth", "hunting")

    # Sidebands, the first ones first: where several meet, the nearest names the order.
    for n in range(1, sidebands + 1):
        for k in range(1, harmonics + 1):
            for gear, teeth in (("pinion", gears.pinion_teeth), ("wheel", gears.wheel_teeth)):
                if n <= min(sidebands, indicators.sidebands_of(teeth)):
                    for sign, side in (("-", -n), ("+", n)):
                        order = k * gears.pinion_teeth + side * turns[gear]
                        if order > 0:
                            add(order, f"mesh {k} {sign} {n} {gear}", gear)
    for k in range(1, harmonics + 1):
        for sign, side in (("-", -hunting), ("+", hunting)):
            add(k * gears.pinion_teeth + side, f"mesh {k} {sign} 1 hunting tooth", "hunting")
    return sorted(found.values(), key=lambda line: line.order)


def of_ghosts(text, gears):
    """`131, wheel:144`: events per turn of the pinion, or of the wheel."""
    found = []
    for part in text.split(","):
        gear, colon, number = part.strip().rpartition(":")
        if colon and (gear not in ("pinion", "wheel") or gears is None):
            raise program.InputError(f"--ghost: must be N, pinion:N or wheel:N with known teeth (got '{part.strip()}')")
        order = orders_asked(number, "--ghost")[0]
        if gear == "wheel":
            order *= Fraction(gears.pinion_teeth, gears.wheel_teeth)
        found.append(Line(order, f"ghost {part.strip()}", "ghost"))
    return found


def of_planetary(text, harmonics):
    """`SUN,PLANET,RING,NUMBER`: lines per turn of the sun, of a set with a fixed ring.

    The carrier turns z_s / (z_s + z_r) for each turn of the sun; seen from it the ring goes back by as much, so that
    z_r teeth mesh in a turn of it, and a planet turns z_r / z_p.
    """
    parts = [part.strip().removeprefix("-") for part in text.split(",")]
    if len(parts) != 4 or not all(part.isascii() and part.isdigit() and 0 < int(part[:6]) < 10**5 for part in parts):
        raise program.InputError(f"--planetary: must be SUN,PLANET,RING,NUMBER, teeth and planets (got '{program.shown(text)}')")
    sun, planet, ring, number = map(int, parts)
    carrier = Fraction(sun, sun + ring)
    found = [Line(carrier, "carrier", "planet"), Line(carrier * number, "planets pass", "planet"),
             Line(carrier * Fraction(ring, planet), "planet turns", "planet"),
             Line((1 - carrier) * number, "planets pass the sun", "planet")]
    found += [Line(k * carrier * ring, f"mesh {k}", "mesh") for k in range(1, harmonics + 1)]
    return sorted(found, key=lambda line: line.order)


def name_of(order, lines, width):
    """Name of the nearest line, None if there is none within a width; teeth before turns."""
    near = [line for line in lines if abs(float(line.order) - order) <= width]
    return min(near, key=lambda line: (abs(float(line.order) - order) > width / 4, KINDS.index(line.kind))).name if near else None


def named_turns(order, gears, width):
    """`131 per turn of the pinion` of an order without a name, None if it is whole for neither gear."""
    for gear, turn in (("pinion", 1.0), ("wheel", gears.pinion_teeth / gears.wheel_teeth)):
        count = round(order / turn)
        if count > 0 and abs(count * turn - order) <= width:
            return f"{count} per turn of the {gear}"
    return None


# ----------------------------------------------------------------------------------------------------
# Pictures
# ----------------------------------------------------------------------------------------------------


def speed_rim(orders, frequency_high, row_low, row_high, constant_rpm=None):
    """Variables of speed_map.gp: where the lines of orders leave a map of frequency over speed, and their numbers.

    All in shares of the map. At a constant speed lines are upright. A number that would stand on another one is left out.
    """
    out, letter, line = 1.014, 0.0125, 0.035
    values, taken, count = {}, [], 0
    height = row_high - row_low
    for order in orders:
        if constant_rpm is not None:
            x = order * constant_rpm / 60.0 / frequency_high
            ends = (x, 1.0, x, out)
        else:
            leaves_rpm = 60.0 * frequency_high / order
            if leaves_rpm < row_high:
                ends = (1.0, (leaves_rpm - row_low) / height, out, (leaves_rpm * out - row_low) / height)
            else:
                x = order * row_high / 60.0 / frequency_high
                ends = (x, 1.0, x * (1.0 + (out - 1.0) * height / row_high), out)
        # Where its number stands: above the map or beside it.
        text = f"{order:.5g}"
        middle = ends[2] if ends[0] < 1.0 else ends[2] + letter * (0.5 * len(text) + 1)
        place = (middle, ends[3], 0.5 * letter * (len(text) + 1))
        is_clear = all(abs(place[0] - x) > place[2] + half or abs(place[1] - y) > line for x, y, half in taken)
        if ends[0] <= 1.0 and 0.0 < ends[1]:
            taken += [place] if is_clear else []
            names = ("mark_x", "mark_y", "mark_out_x", "mark_out_y")
            values.update({f"{name}_{count}": float(end) for name, end in zip(names, ends)})
            values[f"mark_text_{count}"] = text if is_clear else ""
            count += 1
    return {**values, "marks": count}


def rim_values(known, asked, edge, scale=1.0, letters=87, levels=3):
    """Variables of rim.gp: names above a picture that reaches up to an order and is so many letters wide.

    `scale` is what the axis of the picture says at order 1, where it does not tell orders.
    """
    named = [(float(line.order), line.name) for line in known
             if not line.is_sideband and line.kind in ("mesh", "ghost", "planet") and line.order <= edge]
    named += [(float(order), name_of(float(order), known, 1e-6)) for order in asked
              if order <= edge and all(abs(float(order) - other) > 1e-6 for other, _ in named)]

    # Each on the lowest level where it has room.
    values, ends, count = {}, [-math.inf] * levels, 0
    for order, name in sorted(named, key=lambda line: line[0]):
        text = f"{order:.5g} {name}" if name else f"{order:.5g}"
        half = 0.5 * (len(text) + 1) / letters * edge
        level = next((i for i, end in enumerate(ends) if order - half > end), None)
        if level is not None:
            ends[level] = order + half
            values.update({f"rim_at_{count}": scale * order, f"rim_text_{count}": text, f"rim_level_{count}": level})
            count += 1
    for kind in ("pinion", "wheel", "hunting"):
        values[f"{kind}_orders"] = [scale * float(line.order) for line in known if line.kind == kind and line.order <= edge]
    return {**values, "rim_lines": count}
