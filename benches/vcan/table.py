"""Makes a table of lines `ROUND NAME RATE`: medians over the rounds, and of the ratios within each round."""

import statistics
import sys
from collections import defaultdict

# What a row is a multiple of.
SEGMENTED = {"segmented", "fieldproof-segmented", "python-canopen-segmented"}
BLOCK = {"fieldproof-block", "python-canopen-block"}


def base_of(name: str) -> str:
    if name in SEGMENTED:
        return "segmented"
    return "python-canopen-block" if name in BLOCK else "bare"


def main() -> None:
    rates: defaultdict[str, dict[str, float]] = defaultdict(dict)
    for line in sys.stdin:
        turn, name, rate = line.split()
        rates[name][turn] = float(rate)
    print(f"{'':26}{'median':>9}{'least':>9}{'most':>9}  {'ratio':>6}  {'middle half':<14}")
    for name, of_name in sorted(rates.items(), key=lambda it: (base_of(it[0]), it[0] != base_of(it[0]))):
        base = rates.get(base_of(name), {})
        ratios = [rate / base[turn] for turn, rate in of_name.items() if turn in base]
        if not ratios:
            print(f"{name:26}{statistics.median(of_name.values()):9.0f}  nothing to compare it with")
            continue
        low, middle, high = statistics.quantiles(ratios, n=4) if len(ratios) > 1 else ratios * 3
        values = f"{statistics.median(of_name.values()):9.0f}{min(of_name.values()):9.0f}{max(of_name.values()):9.0f}"
        print(f"{name:26}{values}  {middle:6.3f}  {low:.3f} to {high:.3f} of {base_of(name)}")


if __name__ == "__main__":
    main()
