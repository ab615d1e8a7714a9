from palpate.cli.body.figure_lines import as_lines


def test_figures_are_told_one_a_line_with_six_digits():
    told = as_lines({"young_modulus": 103397.63100377623, "key": "3975355f", "exact": True})
    assert told.splitlines() == [
        "young modulus  103398",
        "key            3975355f",
        "exact          yes",
    ]


def test_beside_large_numbers_rounding_is_nothing():
    force = [-2.767e-17, 2.058e-17, 0.6826415653674401]
    assert as_lines({"force": force}) == "force  0 0 0.682642"
    assert as_lines({"force": [-0.0, 0.0]}) == "force  0 0"
    assert as_lines({"forces": [force, [0.0, 1e-6, 0.0]]}) == "forces  0 0 0.682642; 0 1e-06 0"


def test_numbers_of_nodes_keep_all_digits():
    assert as_lines({"triangle": [12345678, 0, 7]}) == "triangle  12345678 0 7"


def test_what_is_not_known_is_not_told_and_names_go_with_their_figures():
    figures = {"fit": None, "warnings": [], "seconds": {"bake": 0.25, "pin": 1.0}}
    assert as_lines(figures) == "seconds  bake 0.25, pin 1"
    assert as_lines({"lateness_us": {"p99_9": 40.0}}) == "lateness us  p99.9 40"
    assert as_lines({"where": ["a", None]}) == "where  a, None"
    assert as_lines({"surface": [float("nan"), 1.0, 2.0]}) == "surface  nan 1 2"
    assert as_lines({"faults": {}}) == "faults  none"
    assert as_lines({}) == ""
