"""Forces of a press that come to no rest: each cause is an error of its own."""

import numpy as np
import pytest

from palpate.core.contact.place import nearest_place
from palpate.core.contact.press import Press
from palpate.core.contact.single_press import set_down
from palpate.core.contact.tool.tools import sphere
from palpate.core.contact.unsettled import NotANumberError, UnsettledError
from palpate.core.errors import PalpateError

TIP = sphere(0.008)
ON_THE_BACK = np.array([-0.027, -0.014, 0.057])


class Engine:
    """An engine that finds no rest, for a reason."""

    def __init__(self, problem: Exception) -> None:
        self.problem = problem

    def settle(self, _targets: object) -> None:
        raise self.problem


@pytest.mark.parametrize(
    ("problem", "kind"),
    [
        (RuntimeError("it still changes"), UnsettledError),
        (FloatingPointError("no number"), NotANumberError),
        (ValueError("too many strides away"), PalpateError),
    ],
)
def test_each_cause_is_an_error_of_its_own(mouse, problem, kind):
    press = Press(mouse, [TIP])
    press._engine = Engine(problem)
    start = set_down(mouse, TIP, nearest_place(mouse, ON_THE_BACK))
    with pytest.raises(PalpateError, match=f"press: {problem}") as caught:
        press.to([start])
    assert type(caught.value) is kind
