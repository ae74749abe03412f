# SPDX-License-Identifier: BSL-1.0
"""Machines with two positions, simulated by laws of their own: a two-mass drive under a P-PI loop, and a step counter with a scale.
Nothing here is the diagnosis' own law: contact, friction and rounding are integrated step by step."""
import math
import random


def rounded(x, count):
    return math.floor(x / count + 0.5) * count if count else x


def stopped(v, by):
    """A velocity that friction slows by this much at most."""
    return 0.0 if abs(v) <= by else v - math.copysign(by, v)


def two_encoders(path, seed, stiffness=2e8, play=0.0, pitch=0.0, lead=0.0, motor_friction=0.0, friction=30.0, mass=100.0,
                 motor_mass=30.0, motor_count=0.16e-6, count=1e-6, viscous=60.0, band=60.0, constant=100.0, seconds=8.0):
    """Writes path.csv (2 kHz) and returns the machine file that knows the plant, without the effects of the transmission."""
    rng = random.Random(seed)
    period, parts, turn = 0.0005, 40, 0.01
    h, load = period / parts, mass - motor_mass
    damping = 0.1 * math.sqrt(stiffness * load * motor_mass / mass)
    f1, f2, f3 = rng.uniform(0.3, 0.5), rng.uniform(1.2, 2.0), rng.uniform(3.0, 5.0)
    a1, a2, a3 = rng.uniform(0.03, 0.05), rng.uniform(4e-3, 7e-3), rng.uniform(1e-3, 2.5e-3)
    phase = rng.uniform(0, 2 * math.pi)

    def reference(t):
        soft = min(1.0, t)
        return (a1 * (1 - math.cos(2 * math.pi * f1 * t)) +
                soft * (a2 * math.sin(2 * math.pi * f2 * t) + a3 * math.sin(2 * math.pi * f3 * t)))

    position_gain = 2 * math.pi * band / 5
    gain = 2 * math.pi * band * mass / constant
    x = y = v = w = integral = slow = before = 0.0
    rows = []
    for i in range(int(seconds / period)):
        t = i * period
        motor, scale, r = rounded(x, motor_count), rounded(y, count), reference(t)
        slow += 0.3 * ((motor - before) / period - slow)
        before = motor
        e = position_gain * (r - scale) + (reference(t + period) - r) / period - slow
        integral = max(-8.0, min(8.0, integral + gain * band * period * e))
        u = rounded(max(-10.0, min(10.0, gain * e + integral)), 20 / 65536)
        rows.append((t, r, scale, motor / turn * 2 * math.pi, u))
        for _ in range(parts):
            d = x * (1 + lead) + pitch * math.sin(2 * math.pi * x / turn + phase) - y
            pressed = 0.0
            if abs(d) > play / 2:
                pressed = stiffness * (d - math.copysign(play / 2, d)) + damping * (v - w)
                if pressed * d < 0:
                    pressed = 0.0
            v = stopped(v + h * (constant * u - pressed) / motor_mass, h * motor_friction / motor_mass)
            w = stopped(w + h * (pressed - viscous * w) / load, h * friction / load)
            x += h * v
            y += h * w
    with open(path + ".csv", "w") as out:
        out.write("t_s,x_ref_m,x_pos_m,x_motor_pos_rad,x_cmd_V\n")
        for row in rows:
            out.write("%.6f,%.9f,%.9f,%.9f,%.9g\n" % row)
    return {
        "schema": "quadrant.machine/1", "sample_period_s": period, "axes": {"x": {
            "plant": {"mass_kg": mass, "force_constant_N_per_V": constant, "viscous_N_s_per_m": viscous,
                      "coulomb_N": friction},
            "tolerance": {"mass": 0.02, "force_constant": 0.01, "viscous": 0.1, "coulomb": 0.05, "stiffness": 0.1,
                          "backlash": 0.1},
            "encoder": {"resolution_m": count},
            "actuator": {"limit_V": 10, "dac_bits": 16, "dac_range_V": 20},
            "transmission": {"kind": "screw", "travel_per_turn_m": turn, "motor_mass_kg": motor_mass},
            "motor_encoder": {"resolution_rad": motor_count / turn * 2 * math.pi}}}}


def positions(path, seed, period=0.02, seconds=90.0, play=0.0, lead=0.0, pitch=0.0, bend=0.0, lag=0.0, late=0.0, steps=(),
              counter=5e-6, count=1e-6, noise=0.0, drift=0.0, asked=False, travel=0.2):
    """A step counter (or what was asked) and a scale, at 1 / period: point to point and short moves. Writes path.csv."""
    rng = random.Random(seed)
    parts, turn, acceleration = 20, 0.005, 0.3
    h = period / parts
    x = v = target = y = follows = lost = wait = 0.0
    fastest, past, rows, coming = 0.04, [], [], list(steps)
    for i in range(int(seconds / period)):
        t = i * period
        for _ in range(parts):
            if wait > 0:
                wait -= h
            elif x == target and v == 0:
                far = rng.random() < 0.8
                target = rng.uniform(0, travel) if far else min(travel, max(0, x + rng.choice([-1, 1]) * rng.uniform(5e-4, 0.01)))
                fastest, wait = rng.choice([0.005, 0.02, 0.04, 0.06]), rng.choice([0, 0, 0.3])
            else:
                d = target - x
                wanted = math.copysign(min(fastest, math.sqrt(2 * acceleration * abs(d))), d)
                v += max(-acceleration * h, min(acceleration * h, wanted - v))
                if abs(d) < 1e-6:
                    x, v = target, 0.0
                else:
                    x += v * h
            past.append(x)
            follows = follows + (x - follows) * (1 - math.exp(-h / lag)) if lag else past[max(0, len(past) - 1 - round(late / h))]
            motor = rounded(follows, counter) - lost
            place = 2 * motor / travel - 1
            geared = motor * (1 + lead) + pitch * math.sin(2 * math.pi * motor / turn + 0.4) + bend * place * place
            y = min(max(y, geared - play / 2), geared + play / 2)
        while coming and t >= coming[0][0]:
            lost += coming.pop(0)[1]
        rows.append((t, rounded(x, counter), rounded(y + drift * t + rng.gauss(0, noise), count)))
    with open(path + ".csv", "w") as out:
        out.write("t_s,%s,x_pos_m\n" % ("x_ref_m" if asked else "x_motor_pos_m"))
        for row in rows:
            out.write("%.4f,%.7f,%.7f\n" % row)
    return {"schema": "quadrant.machine/1", "sample_period_s": period, "axes": {"x": {
        "transmission": {"kind": "screw", "travel_per_turn_m": turn}, "encoder": {"resolution_m": count}}}}
