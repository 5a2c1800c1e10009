"""Places: results arrive whole or not at all, and nothing that is not ours is touched."""

from pathlib import Path

import pytest

from ident.places import new_file, new_folder
from models.quantity import InvalidInput


def earlier_result(folder: Path) -> Path:
    folder.mkdir()
    (folder / "manifest.json").write_text("{}")
    (folder / "old.txt").write_text("old")
    return folder


def contents(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def test_folder_appears_only_at_the_end(tmp_path: Path) -> None:
    out = tmp_path / "result"
    with new_folder(out) as temporary:
        (temporary / "report.md").write_text("new")
        assert not out.exists()
    assert contents(tmp_path) == {"result"}
    assert contents(out) == {"report.md"}


def test_empty_folder_and_earlier_result_are_replaced_whole(tmp_path: Path) -> None:
    out = tmp_path / "result"
    out.mkdir()
    with new_folder(out) as temporary:
        (temporary / "manifest.json").write_text("{}")
    with new_folder(out) as temporary:
        (temporary / "new.txt").write_text("new")
        assert contents(out) == {"manifest.json"}
    assert contents(out) == {"new.txt"}
    assert contents(tmp_path) == {"result"}


@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError, SystemExit])
def test_an_interrupt_leaves_the_earlier_result(tmp_path: Path, error: type[BaseException]) -> None:
    out = earlier_result(tmp_path / "result")

    def work() -> None:
        with new_folder(out) as temporary:
            (temporary / "half.txt").write_text("half")
            raise error

    with pytest.raises(error):
        work()
    assert contents(out) == {"manifest.json", "old.txt"}
    assert contents(tmp_path) == {"result"}


def test_a_failed_swap_puts_the_earlier_result_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = earlier_result(tmp_path / "result")
    rename = Path.rename

    def failing(self: Path, target: Path) -> Path:
        if (self / "new.txt").exists():
            raise OSError(5, "Input/output error")
        return rename(self, target)

    monkeypatch.setattr(Path, "rename", failing)
    with pytest.raises(InvalidInput, match="Input/output error"), new_folder(out) as temporary:
        (temporary / "new.txt").write_text("new")
    assert contents(out) == {"manifest.json", "old.txt"}
    assert contents(tmp_path) == {"result"}


def test_what_may_not_be_replaced_is_refused_before_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    other = tmp_path / "other"
    other.mkdir()
    (other / "thesis.txt").write_text("mine")
    file = tmp_path / "file"
    file.write_text("mine")
    here = tmp_path / "here"
    here.mkdir()
    loop = tmp_path / "loop"
    loop.symlink_to(loop)
    monkeypatch.chdir(here)
    for out, words in (
        (other, "something else"),
        (file, "is a file"),
        (here, "current folder"),
        (tmp_path, "current folder"),
        (Path("/"), "current folder"),
        (tmp_path / "no" / "result", "no folder"),
        (file / "result", "no folder"),
        (loop, "cannot be"),
        (tmp_path / ("x" * 300), "cannot be written"),
        (Path("a\0b"), "cannot be written"),
    ):
        with pytest.raises(InvalidInput, match=words), new_folder(out):
            pytest.fail("the work began")
    assert contents(tmp_path) == {"other", "file", "here", "loop"}
    assert contents(other) == {"thesis.txt"}


def test_folder_filled_during_the_work_is_kept(tmp_path: Path) -> None:
    out = tmp_path / "result"

    def work() -> None:
        with new_folder(out):
            out.mkdir()
            (out / "theirs.txt").write_text("theirs")

    with pytest.raises(InvalidInput, match="something else"):
        work()
    assert contents(out) == {"theirs.txt"}
    assert contents(tmp_path) == {"result"}


def test_write_protected_parent_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ident.places.os.access", lambda *_: False)
    for place in (new_folder, new_file):
        with pytest.raises(InvalidInput, match="write-protected"), place(tmp_path / "result"):
            pytest.fail("the work began")


def test_link_to_a_folder_stays_a_link(tmp_path: Path) -> None:
    real = earlier_result(tmp_path / "real")
    link = tmp_path / "link"
    link.symlink_to(real)
    with new_folder(link) as temporary:
        (temporary / "new.txt").write_text("new")
    assert link.is_symlink()
    assert contents(real) == {"new.txt"}


def test_file_is_replaced_in_one_step(tmp_path: Path) -> None:
    out = tmp_path / "trace.csv"
    out.write_text("old")
    with new_file(out) as temporary:
        assert temporary.suffix == ".csv"
        temporary.write_text("new")
        assert out.read_text() == "old"
    assert out.read_text() == "new"
    assert contents(tmp_path) == {"trace.csv"}


def test_failed_file_leaves_the_old_one(tmp_path: Path) -> None:
    out = tmp_path / "trace.csv"
    out.write_text("old")

    def work() -> None:
        with new_file(out) as temporary:
            temporary.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        work()
    assert out.read_text() == "old"
    assert contents(tmp_path) == {"trace.csv"}


def test_file_in_place_of_a_folder_or_device_is_refused(tmp_path: Path) -> None:
    for out, words in (
        (tmp_path, "is a folder"),
        (Path("/dev/null"), "not a regular"),
        (tmp_path / "a" / "b", "no folder"),
    ):
        with pytest.raises(InvalidInput, match=words), new_file(out):
            pytest.fail("the work began")
