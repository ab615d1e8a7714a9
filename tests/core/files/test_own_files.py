"""Files of Palpate's own: recognised by their contents, reached by no link."""

import os

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from palpate.core.body import body_file
from palpate.core.body.body_name import body_name, is_body_name
from palpate.core.files.atomic_file import UnwritableError, atomic_file
from palpate.core.files.own_file import is_free, is_own, stays_within
from palpate.core.shape.paper.table_file import FORMAT as TABLE
from palpate.core.shape.paper.table_file import write_table

KEY = "0123456789abcdef" * 4
WORD = body_file.FORMAT


def test_a_body_file_is_known_by_its_beginning_also_cut_short_or_damaged(cube, tmp_path):
    path = tmp_path / "any name"
    body_file.save(cube, path)
    assert is_own(path, WORD)
    assert not is_own(path, TABLE)
    content = path.read_bytes()
    for damaged in (content[:2000], content[:1000] + b"x" + content[1001:]):
        path.write_bytes(damaged)
        assert is_own(path, WORD)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04", b"palpate-body", b"x" * 1000])
def test_what_begins_otherwise_is_not_palpates(tmp_path, content):
    path = tmp_path / "cube-0123456789ab.npz"
    path.write_bytes(content)
    assert not is_own(path, WORD)
    assert not is_free(path, WORD)
    np.savez(path, X=np.eye(3), word=np.array(WORD))
    assert not is_own(path, WORD)


def test_links_pipes_and_folders_are_not_palpates(cube, tmp_path, link):
    body_file.save(cube, tmp_path / "body.npz")
    link(tmp_path / "link", tmp_path / "body.npz")
    link(tmp_path / "dangling", tmp_path / "nothing")
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "pipe")
    for name in ("link", "dangling", "folder", "pipe"):
        assert not is_own(tmp_path / name, WORD)
        assert not is_free(tmp_path / name, WORD)
    assert is_free(tmp_path / "nothing", WORD)


def test_a_folder_stays_within_its_parent_unless_it_is_a_link_out(tmp_path, link):
    (tmp_path / "scene" / "bodies").mkdir(parents=True)
    link(tmp_path / "scene" / "in", tmp_path / "scene" / "bodies")
    link(tmp_path / "scene" / "out", tmp_path)
    for name, stays in (("bodies", True), ("in", True), ("none yet", True), ("out", False)):
        assert stays_within(tmp_path / "scene" / name, tmp_path / "scene") == stays


def test_a_table_replaces_neither_what_a_link_leads_to_nor_another_file(tmp_path, link):
    (tmp_path / "letter").write_text("dear")
    link(tmp_path / "link.npz", tmp_path / "letter")
    for name in ("link.npz", "letter"):
        with pytest.raises(UnwritableError, match="no table"):
            write_table(tmp_path / name, "newton-table", KEY, {})
    assert (tmp_path / "letter").read_text() == "dear"
    write_table(tmp_path / "new.npz", "newton-table", KEY, {})
    write_table(tmp_path / "new.npz", "newton-table", KEY, {"a": np.eye(2)})


def test_a_file_may_take_a_links_place(tmp_path, link):
    (tmp_path / "letter").write_text("dear")
    link(tmp_path / "link", tmp_path / "letter")
    with atomic_file(tmp_path / "link", follows_links=False) as file:
        file.write(b"new")
    assert (tmp_path / "letter").read_text() == "dear"
    assert (tmp_path / "link").read_text() == "new"


@given(st.text(max_size=300), st.integers(1, 1000))
def test_every_object_gets_a_name_for_its_body(word, number):
    name = body_name(word, KEY, number)
    assert is_body_name(name, KEY)
    assert len(name.encode()) < 240
    assert os.path.basename(name) == name  # noqa: PTH119 - what a system calls a bare name


@given(st.text(max_size=40) | st.builds("{}-0123456789ab.npz".format, st.text(max_size=40)))
def test_no_other_name_is_one(name):
    if is_body_name(name, KEY):
        assert name.endswith("-0123456789ab.npz")
        assert not set(name) & set('/\\:*?"<>|\0\n\r\t .') - {"."}
        assert name.count(".") == 1


@pytest.mark.parametrize("key", ["", "x", "0123456789ab", KEY.upper(), KEY + "0", "../" + KEY[3:]])
def test_a_key_of_another_form_has_no_name(key):
    assert not is_body_name("cube-0123456789ab.npz", key)
    with pytest.raises(ValueError, match="no name"):
        body_name("cube", key)
