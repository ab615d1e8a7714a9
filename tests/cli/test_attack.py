"""``palpate devices attack``: what is printed, what is published, and how it ends."""

import json
import os

import pytest

from palpate.cli.main import main
from palpate.core.errors import PalpateError
from palpate.simulated.attack.kept import keep_rows, kept_rows
from palpate.simulated.attack.published import REAL, published
from palpate.simulated.attack.table import Row, Table

BEGIN, END = "<!-- attack: begin -->", "<!-- attack: end -->"
KEPT = Table("kept", (Row("a fault", 3, "stale", ()),))


def attack(*words):
    return main(["devices", "attack", *words])


def test_the_same_seed_prints_the_same_table(capsys):
    said = []
    for seed in ("1", "1"):
        assert attack("simulated:link2", "--times", "2", "--seed", seed, "--only", "noise") == 0
        said.append(capsys.readouterr().out)
    assert said[0] == said[1]
    assert "62 to 1,500 bytes of noise" in said[0]
    assert said[0].count(" ok") == 1


def test_every_kind_of_device_has_a_table_of_its_own(capsys):
    assert attack("simulated", "--times", "1", "--only", "switched off by", "--json") == 0
    tables = json.loads(capsys.readouterr().out)["tables"]
    assert [table["title"].partition(")")[0] for table in tables] == [
        "A hostile device (link1",
        "A hostile device (link2",
        "A hostile device (haply",
    ]
    assert [row["broken"] for table in tables for row in table["rows"]] == [[], [], []]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["simulated:mouse"], "simulated:mouse: no such kind"),
        (["simulated", "--only", "no such thing"], "no injection has 'no such thing'"),
        (["simulated", "--times", "0"], "--times must be at least 1"),
        (["simulated", "--body", "missing.npz"], "missing.npz"),
        (["simulated", "--kept", "rows.json"], "--kept goes with --real"),
    ],
)
def test_what_cannot_be_attacked_is_refused(capsys, words, said):
    assert attack(*words) == 2
    assert said in capsys.readouterr().err


def test_tables_are_published_between_two_lines_that_stay(tmp_path):
    document = tmp_path / "safety.md"
    document.write_text(f"before\n{BEGIN}\nold\n{END}\nafter\n")
    words = ["--times", "1", "--only", "noise", "--publish", str(document)]
    assert attack("simulated:link2", *words) == 0
    text = document.read_text()
    assert text.startswith(f"before\n{BEGIN}\n```text\n")
    assert text.endswith(f"```\n{END}\nafter\n")
    assert "noise" in text
    assert "\nold\n" not in text


def test_tables_of_real_processes_have_a_place_of_their_own():
    real = "<!-- real attack: begin -->\nold\n<!-- real attack: end -->\n"
    text = published(f"{BEGIN}\nvirtual\n{END}\n{real}", [KEPT], REAL)
    assert "virtual" in text
    assert "\nold\n" not in text
    assert text.index("a fault") > text.index(END)


def test_several_parts_of_names_may_be_chosen(capsys):
    only = ["--only", "of noise", "a STATE twice"]
    assert attack("simulated:link2", "--times", "1", *only) == 0
    assert capsys.readouterr().out.count(" ok") == 2


def test_a_document_without_a_place_for_tables_is_left_alone():
    with pytest.raises(PalpateError, match="no place for the tables"):
        published("no such lines", [KEPT])


def test_a_broken_rule_ends_the_command_with_1(monkeypatch):
    broken = Table("broken", (Row("a fault", 3, "stale", ("no ramp (1)",)),))
    for tables, status in (([KEPT], 0), ([KEPT, broken], 1)):
        monkeypatch.setattr(
            "palpate.cli.press.attack.virtual_tables", lambda *_, tables=tables: iter(tables)
        )
        assert attack("simulated") == status


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="needs pseudo-terminals")
def test_an_attack_that_was_broken_off_goes_on_where_it_was(tmp_path, capsys):
    """A row that is kept is not tried again, and stands where it would."""
    before = Row("no reader for 1 s, ring full", 1, "kept", (), zero_ms=float("inf"), note="once")
    kept = tmp_path / "rows.json"
    keep_rows(kept, 1, {before.injected: before})
    words = ["simulated", "--real", "--times", "1", "--kept", str(kept)]
    assert attack(*words, "--only", "no reader", "the plug") == 0
    said = capsys.readouterr()
    assert "kept" in said.out
    assert "the plug pulled" in said.out
    assert "on a pseudo-terminal: no reader" not in said.err
    rows = kept_rows(kept, 1)
    assert rows[before.injected] == before
    assert len(rows) == 2
    assert kept_rows(tmp_path / "none yet", 1) == {}


@pytest.mark.parametrize("text", ["", "[]", '{"times": 20}', '{"times": 1, "rows": [{"a": 1}]}'])
def test_other_files_are_no_kept_rows(tmp_path, text):
    kept = tmp_path / "rows.json"
    kept.write_text(text)
    with pytest.raises(PalpateError, match=r"rows\.json"):
        kept_rows(kept, 1)


def test_kept_rows_are_of_as_many_times(tmp_path):
    kept = tmp_path / "rows.json"
    keep_rows(kept, 20, {})
    with pytest.raises(PalpateError, match="go on with --times 20"):
        kept_rows(kept, 50)
