"""A file is read where its folder has the name of a user of anywhere, and others may delete it."""

import pytest

from palpate.core.files.windows.shared_reading import open_shared


def test_a_folder_with_letters_of_anywhere(tmp_path):
    folder = tmp_path / "Jörg Σωκράτης 猫"
    folder.mkdir()
    path = folder / "body"
    path.write_bytes(b"body")
    with open_shared(path) as stream:
        path.unlink()
        assert stream.read() == b"body"


def test_a_file_that_is_not_there_is_told_as_such(tmp_path):
    with pytest.raises(FileNotFoundError):
        open_shared(tmp_path / "nothing")
