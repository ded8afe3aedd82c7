"""Searches of PyPI `cma` and `scipy` on the functions of the example `optimise`, as the same table.

python3 compare.py [--first-seed N] [--seeds N] [--dimensions N] [--method scipy|cma] [--jobs N]; needs numpy, scipy and
cma. scipy starts again with another seed when it has converged; cma restarts by BIPOP.
"""
import argparse
import math
import multiprocessing
import warnings
from math import cos, exp, hypot, pi, sin, sqrt

warnings.filterwarnings("ignore")
import cma  # noqa: E402
import numpy as np  # noqa: E402
from scipy.optimize import differential_evolution  # noqa: E402


def schaffer(p, wave):
    x, y = p[0] ** 2, p[1] ** 2
    return 0.5 + (wave(x - y) ** 2 - 0.5) / (1 + 0.001 * (x + y)) ** 2


def levi(p):
    wave = lambda x: sin(pi * x) ** 2
    x, y = p
    return wave(3 * x) + (x - 1) ** 2 * (1 + wave(3 * y)) + (y - 1) ** 2 * (1 + wave(2 * y))


def goldstein(p):
    x, y = p
    a = 19 - 14 * x + 3 * x * x - 14 * y + 6 * x * y + 3 * y * y
    b = 18 - 32 * x + 12 * x * x + 48 * y - 36 * x * y + 27 * y * y
    return (1 + (x + y + 1) ** 2 * a) * (30 + (2 * x - 3 * y) ** 2 * b)


def ackley(p):
    n = len(p)
    return (-20 * exp(-0.2 * sqrt(sum(x * x for x in p) / n))
            - exp(sum(cos(2 * pi * x) for x in p) / n) + math.e + 20)


def beale(p):
    x, y = p
    return (1.5 - x + x * y) ** 2 + (2.25 - x + x * y * y) ** 2 + (2.625 - x + x * y ** 3) ** 2


def eggholder(p):
    x, y = p[0], p[1] + 47
    return -y * sin(sqrt(abs(x / 2 + y))) - x * sin(sqrt(abs(x - y)))


def tray(p):
    return -1e-4 * (abs(sin(p[0]) * sin(p[1]) * exp(abs(100 - hypot(*p) / pi))) + 1) ** 0.1


def rastrigin(p):
    return sum(10 + x * x - 10 * cos(2 * pi * x) for x in p)


def rosenbrock(p):
    return sum(100 * (b - a * a) ** 2 + (1 - a) ** 2 for a, b in zip(p, p[1:]))


def sphere(p):
    return sum(x * x for x in p)


def styblinski(p):
    return sum(0.5 * (x ** 4 - 16 * x * x + 5 * x) for x in p)


FUNCTIONS = [
    ("Ackley function", [(-5.12, 5.12)] * 2, 0, ackley),
    ("Beale function", [(-4.5, 4.5)] * 2, 0, beale),
    ("Booth function", [(-10, 10)] * 2, 0, lambda p: (p[0] + 2 * p[1] - 7) ** 2 + (2 * p[0] + p[1] - 5) ** 2),
    ("Bukin N.6 function", [(-15, -5), (-3, 3)], 0,
     lambda p: 100 * sqrt(abs(p[1] - 0.01 * p[0] ** 2)) + 0.01 * abs(p[0] + 10)),
    ("Cross-in-tray function", [(-10, 10)] * 2, -2.0626118708227369, tray),
    ("Easom function", [(-100, 100)] * 2, -1,
     lambda p: -cos(p[0]) * cos(p[1]) * exp(-((p[0] - pi) ** 2) - (p[1] - pi) ** 2)),
    ("Eggholder function", [(-512, 512)] * 2, -959.6406627208508, eggholder),
    ("Goldstein–Price function", [(-2, 2)] * 2, 3, goldstein),
    ("Himmelblau's function", [(-5, 5)] * 2, 0,
     lambda p: (p[0] ** 2 + p[1] - 11) ** 2 + (p[0] + p[1] ** 2 - 7) ** 2),
    ("Hölder table function", [(-10, 10)] * 2, -19.208502567886732,
     lambda p: -abs(sin(p[0]) * cos(p[1]) * exp(abs(1 - hypot(*p) / pi)))),
    ("Lévi function N.13", [(-10, 10)] * 2, 0, levi),
    ("Matyas function", [(-10, 10)] * 2, 0, lambda p: 0.26 * (p[0] ** 2 + p[1] ** 2) - 0.48 * p[0] * p[1]),
    ("McCormick function", [(-1.5, 4), (-3, 4)], -1.9132229549810364,
     lambda p: sin(p[0] + p[1]) + (p[0] - p[1]) ** 2 - 1.5 * p[0] + 2.5 * p[1] + 1),
    ("Rastrigin function", [(-5.12, 5.12)] * 2, 0, rastrigin),
    ("Rosenbrock function", [(-10, 10)] * 2, 0, rosenbrock),
    ("Schaffer function N.2", [(-100, 100)] * 2, 0, lambda p: schaffer(p, sin)),
    ("Schaffer function N.4", [(-100, 100)] * 2, 0.29257863203598055,
     lambda p: schaffer(p, lambda d: cos(sin(abs(d))))),
    ("Sphere function", [(-10, 10)] * 2, 0, sphere),
    ("Styblinski–Tang function", [(-5, 5)] * 2, -78.33233140754283, styblinski),
    ("Three-hump camel function", [(-5, 5)] * 2, 0,
     lambda p: 2 * p[0] ** 2 - 1.05 * p[0] ** 4 + p[0] ** 6 / 6 + p[0] * p[1] + p[1] ** 2),
    ("Rastrigin function", [(-5.12, 5.12)] * 10, 0, rastrigin),
    ("Rosenbrock function", [(-10, 10)] * 10, 0, rosenbrock),
    ("Sphere function", [(-10, 10)] * 10, 0, sphere),
    ("Styblinski–Tang function", [(-5, 5)] * 10, -391.66165703771415, styblinski),
]


class Found(Exception):
    """The minimum was found, or there are no more evaluations."""


class Counter:
    """Counts the evaluations of a function until its minimum is found."""

    def __init__(self, function, minimum, longest):
        self.function, self.minimum, self.longest = function, minimum, longest
        self.count, self.hit = 0, None

    def __call__(self, p):
        value = self.function([float(x) for x in p])
        self.count += 1
        if value - self.minimum <= 1e-8:
            self.hit = self.count
        if self.hit or self.count >= self.longest:
            raise Found
        return value


def with_scipy(counter, bounds, seed):
    start = 0
    while True:
        differential_evolution(counter, bounds, rng=np.random.default_rng([seed, start]))
        start += 1


def with_cma(counter, bounds, seed):
    low, high = np.array(bounds, float).T
    random = np.random.default_rng(seed)
    unit = lambda u: counter(low + np.asarray(u) * (high - low))
    options = {"bounds": [0, 1], "verbose": -9, "seed": seed, "maxfevals": counter.longest, "verb_log": 0}
    while True:
        cma.fmin2(unit, lambda: random.uniform(size=len(low)), 0.2, options, restarts=9, bipop=True)
        options["seed"] += 1000


METHODS = {"scipy": with_scipy, "cma": with_cma}


def search(work):
    """Evaluations until a search has found the minimum, or None."""
    method, function, seed = work
    _, bounds, minimum, value = FUNCTIONS[function]
    counter = Counter(value, minimum, 10_000 * len(bounds))
    try:
        METHODS[method](counter, bounds, seed)
    except Found:
        pass
    return counter.hit


def cells(results, longest):
    """Share of successes, median evaluations of a success, evaluations per success."""
    hits = sorted(r for r in results if r)
    total = sum(hits) + (len(results) - len(hits)) * longest
    median = hits[len(hits) // 2] if hits else "-"
    each = total // len(hits) if hits else "-"
    return f"{f'{len(hits)}/{len(results)}':>14}{median:>8}{each:>9}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--seeds", type=int, default=30)
    parser.add_argument("--dimensions", type=int, help="only functions with so many dimensions")
    parser.add_argument("--method", choices=list(METHODS), help="only this one")
    parser.add_argument("--jobs", type=int, default=1, help="number of processes")
    arguments = parser.parse_args()
    seeds = range(arguments.first_seed, arguments.first_seed + arguments.seeds)
    methods = [arguments.method] if arguments.method else list(METHODS)
    print(f"{'function':28}{'n':>3}" + "".join(f"{method:>14}{'':17}" for method in methods))
    with multiprocessing.Pool(arguments.jobs) as pool:
        for number, (name, bounds, _, _) in enumerate(FUNCTIONS):
            if arguments.dimensions not in (None, len(bounds)):
                continue
            row = f"{name:28}{len(bounds):3}"
            for method in methods:
                work = [(method, number, seed) for seed in seeds]
                row += cells(pool.map(search, work, chunksize=1), 10_000 * len(bounds))
            print(row, flush=True)


if __name__ == "__main__":
    main()
