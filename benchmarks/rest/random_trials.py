"""Free bodies that are dropped, pressed, pinched and lifted anyhow, a thousand times.

    python benchmarks/rest/random_trials.py [--trials 1000] [--first 0] [--pairs | --steady]

What must hold of each is told in ``tests/referees/rest_trials.py``, and with ``--pairs``, one laid
down on another, in ``pile_trials.py`` there; a trial is known by its seed. With ``--steady`` a hand
keeps bodies from sliding and turning while others press them.
The exit status tells whether all of them hold.
"""

from __future__ import annotations

import argparse
import sys
from functools import partial

from palpate.core.errors import PalpateError
from palpate.tests.referees.pile_trials import pile_trial
from palpate.tests.referees.rest_trials import KINDS, Outcome, trial


def main() -> int:
    """Print the worst of each kind, and the seeds that do not hold."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--trials", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="seed of the first")
    ways = parser.add_mutually_exclusive_group()
    ways.add_argument("--pairs", action="store_true", help="one body laid down on another")
    ways.add_argument("--steady", action="store_true", help="one more hand steadies the body")
    arguments = parser.parse_args()
    tried = pile_trial if arguments.pairs else partial(trial, steady=arguments.steady)
    outcomes: dict[str, list[Outcome]] = {kind: [] for kind in KINDS}
    fallen = []
    for seed in range(arguments.first, arguments.first + arguments.trials):
        kind = KINDS[seed % len(KINDS)]
        try:
            outcome = tried(seed)
        except PalpateError as problem:
            fallen.append(seed)
            print(f"seed {seed}, {kind}: {problem}", flush=True)
            continue
        outcomes[kind].append(outcome)
        if not outcome.holds:
            fallen.append(seed)
            print(f"seed {seed}, {kind}: {outcome}", flush=True)
    print("kind     trials   gained    sunk   stretched   unborne, the most of each")
    for kind, some in outcomes.items():
        if some:
            worst = [
                max(getattr(o, name) for o in some) for name in ("gained", "sunk", "stretched")
            ]
            unborne = max(o.unborne for o in some)
            print(
                f"{kind:8}{len(some):7}{worst[0]:10.1e}{worst[1]:8.3f}{worst[2]:12.3f}"
                f"{unborne:10.1e}"
            )
    print("all hold" if not fallen else f"SEEDS THAT DO NOT HOLD: {fallen}")
    return 1 if fallen else 0


if __name__ == "__main__":
    sys.exit(main())
