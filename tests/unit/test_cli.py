"""The command line: what it calls, what it prints, and how it ends."""

import os
import signal
import subprocess
import sys
import threading
import time
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ident import studies
from ident.builtin import builtin_names, builtin_text
from ident.cli import main
from ident.configuration import load
from ident.exits import exit_code
from ident.places import interruption
from ident.terminal import progress, write_error, write_table
from models.quantity import InvalidInput, NumericalFailure

Capture = pytest.CaptureFixture[str]


class Result:
    """What studies return."""

    table: tuple[dict[str, str], ...] = ({"model": "massless-4-linear", "rms": "0.014"},)
    folder = Path("made")
    notes = ("tow.csv: 1 gap in time",)
    failed: tuple[str, ...] = ()


@pytest.fixture
def called(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Every study replaced by one that only notes its arguments."""
    seen: dict[str, Any] = {}

    def noting(name: str) -> Callable[..., Any]:
        def study(*args: Any, **kwargs: Any) -> Any:
            seen.update(kwargs, study=name, first=args[0] if args else None)
            return f"{name} done" if name in ("simulate", "record") else Result()

        return study

    for name in (
        "run",
        "simulate",
        "record",
        "fit",
        "verify",
        "step",
        "crossval",
        "turn",
        "compare",
        "bench",
        "stability",
        "gallery",
    ):
        module = types.ModuleType(f"ident.studies.{name}")
        setattr(module, name, noting(name))
        if name == "turn":
            setattr(module, "answer_claims", noting("claims"))  # noqa: B010
        monkeypatch.setitem(sys.modules, f"ident.studies.{name}", module)
        monkeypatch.setattr(studies, name, module, raising=False)
    return seen


def error_of(capsys: Capture) -> str:
    """The error line, after checking that it is one line and the only one."""
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("error: ")
    assert captured.err.count("\n") == 1
    assert captured.err.endswith("\n")
    return captured.err


def test_list_shows_name_length_weight_and_description(capsys: Capture) -> None:
    assert main(["list"]) == 0
    heading, *lines = capsys.readouterr().out.splitlines()
    assert heading.split() == ["name", "length_m", "weight_in_water_N", "description"]
    assert [line.split()[0] for line in lines] == list(builtin_names())
    assert lines[0].split()[1:3] == ["1200", "19170"]
    told = {line.split()[0]: line.split()[1:3] for line in lines}
    assert told["s-shape-205"] == ["205", "530"]
    assert told["swath-4000"] == ["4000", "3140"]


@pytest.mark.parametrize("name", builtin_names())
def test_show_is_plain_bytes_that_load_again(
    name: str, capfdbinary: pytest.CaptureFixture[bytes], tmp_path: Path
) -> None:
    assert main(["show", name]) == 0
    data = capfdbinary.readouterr().out
    assert data == builtin_text(name).encode()
    path = tmp_path / "shown.toml"
    path.write_bytes(data)
    assert load(str(path)).tow.cable == load(name).tow.cable


def test_new_writes_a_configuration_once(tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "mine.toml"
    assert main(["new", str(path)]) == 0
    assert load(str(path)).name == "mine"
    path.write_text("mine")
    capsys.readouterr()
    assert main(["new", str(path)]) == 2
    assert "exists" in error_of(capsys)
    assert path.read_text() == "mine"


def test_run_hands_over_its_options(called: dict[str, Any], capsys: Capture) -> None:
    assert main(["run", "mangus-740", "--seed", "3", "--models", "inertial-linear, massless-2-quadratic"]) == 0
    assert called["study"] == "run"
    assert called["first"].name == "mangus-740"
    assert (called["out"], called["seed"]) == (Path("mangus-740"), 3)
    assert called["models"] == ("inertial-4-linear", "massless-2-quadratic")
    assert capsys.readouterr().out.splitlines()[:2] == ["model                rms", "massless-4-linear  0.014"]


def test_other_commands_hand_over_their_options(called: dict[str, Any], tmp_path: Path) -> None:
    out, ship = str(tmp_path / "out.csv"), str(tmp_path / "ship.csv")
    assert main(["simulate", "autec-1200", "--ship", ship, "--out", out, "--stepper", "runge-kutta"]) == 0
    assert (called["reference"], called["tolerance"], called["start"], called["stepper"]) == (
        ("spectral", None, None, "runge-kutta")
    )
    assert called["links"] is None
    chain = ["--reference", "link-joint", "--links", "9"]
    assert main(["simulate", "autec-1200", "--ship", ship, "--out", out, *chain]) == 0
    assert (called["reference"], called["links"], called["stepper"]) == ("link-joint", 9, None)
    assert main(["record", "autec-1200", "--input", "u-turn", "--reference", "link-joint", "--out", out]) == 0
    assert (called["kind"], called["reference"]) == ("u-turn", "link-joint")
    assert main(["record", "autec-1200", "--input", "standard+sea", "--duration", "60", "--sensor", "--out", out]) == 0
    assert (called["kind"], called["duration"], called["sensor"], called["seed"]) == ("standard+sea", 60.0, True, 0)
    line = ["fit", "autec-1200", "--record", ship, "--record", "b.csv", "--model", "massless-linear", "--out", out]
    assert main([*line, "--fixed-delay", "--budget", "50"]) == 0
    assert called["records"] == (Path(ship), Path("b.csv"))
    assert (called["models"], called["budget"], called["starts"]) == (("massless-4-linear",), 50, None)
    assert called["fixed_delay"] is True
    assert main(["verify", "FIT.json", "--record", ship, "--out", out]) == 0
    assert (called["first"], called["start"]) == (Path("FIT.json"), None)
    assert main(["step", "autec-1200", "--out", out, "--quiet"]) == 0
    assert main(["crossval", "deep-tow-camera", "--record", ship, "--out", out]) == 0
    assert (called["fraction"], called["start"]) == (0.6, "steady")
    assert main(["gallery"]) == 0
    assert called["out"] == Path("reports/gallery")


def test_turn_hands_over_lists_and_knots(called: dict[str, Any], tmp_path: Path) -> None:
    out = str(tmp_path / "out")
    line = ["turn", "multipart-2200", "--out", out, "--quiet", "--speed", "6 kn, 2 m/s", "--radius", "250,500"]
    assert main([*line, "--turns", "2", "--parts", "1,3", "--length", "2200"]) == 0
    assert called["speeds"] == pytest.approx((6.0 * 1852.0 / 3600.0, 2.0))
    assert (called["radii"], called["turns"], called["parts"]) == ((250.0, 500.0), (2.0,), (1, 3))
    assert (called["lengths"], called["u_turn"], called["out"]) == ((2200.0,), False, Path(out))
    assert main(["turn", "multipart-2200", "--out", out, "--quiet", "--u-turn"]) == 0
    assert (called["u_turn"], called["speeds"], called["turns"]) == (True, (), ())
    assert called["study"] == "turn"
    assert main(["turn", "multipart-2200", "--out", out, "--quiet", "--claims"]) == 0
    assert called["study"] == "claims"


def test_compare_and_bench_take_any_number_of_configurations(called: dict[str, Any]) -> None:
    assert main(["compare", "--quiet"]) == 0
    assert [each.name for each in called["first"]] == ["mangus-740", "autec-1200", "mangus-2500"]
    assert (called["study"], called["out"]) == ("compare", Path("compare"))
    assert main(["bench", "--quiet"]) == 0
    assert [each.name for each in called["first"]] == ["multipart-2200", "autec-1200", "mangus-740", "mangus-2500"]
    assert (called["out"], called["quick"]) == (Path("bench"), False)
    assert main(["bench", "--quick", "--quiet"]) == 0
    assert [each.name for each in called["first"]] == ["multipart-2200", "autec-1200"]
    assert called["quick"]
    assert main(["bench", "mangus-740", "--out", "x", "--quiet"]) == 0
    assert ([each.name for each in called["first"]], called["out"]) == (["mangus-740"], Path("x"))


def test_stability_takes_the_beginnings_of_names(called: dict[str, Any]) -> None:
    assert main(["stability", "--quiet"]) == 0
    assert (called["out"], called["only"], called["quick"]) == (Path("stability"), (), False)
    assert main(["stability", "--only", "chain-length, fit", "--quick", "--out", "x", "--quiet"]) == 0
    assert (called["out"], called["only"], called["quick"]) == (Path("x"), ("chain-length", "fit"), True)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (["run", "nope"], "neither a file nor a built-in"),
        (["run", "autec-1200", "--seed", "-1"], "--seed"),
        (["run", "autec-1200", "--seed", "x"], "--seed"),
        (["run", "autec-1200", "--models", "cubic"], "cubic"),
        (["run", "autec-1200", "--models", "massless-linear,massless-4-linear"], "twice"),
        (["run", "autec-1200", "--models", ""], "model"),
        (["run"], "NAME|FILE"),
        (["--frobnicate"], "--frobnicate"),
        (["frobnicate"], "frobnicate"),
        (["simulate", "autec-1200", "--out", "x.csv"], "--ship"),
        (["simulate", "autec-1200", "--ship", "a", "--out", "b", "--tolerance", "nan"], "--tolerance must be"),
        (["simulate", "autec-1200", "--ship", "a", "--out", "b", "--tolerance", "0"], "0 m/s"),
        (["simulate", "autec-1200", "--ship", "a", "--out", "b", "--start", "fast"], "--start"),
        (["simulate", "autec-1200", "--ship", "a", "--out", "b", "--links", "3"], "--links"),
        (["turn", "multipart-2200", "--out", "b", "--speed", "6 kmh"], "6 kmh"),
        (["turn", "multipart-2200", "--out", "b", "--radius", "250;500"], "--radius needs numbers joined by commas"),
        (["turn", "multipart-2200", "--out", "b", "--parts", "1.5"], "--parts"),
        (["turn", "multipart-2200", "--out", "b", "--claims", "--u-turn"], "sweeps of its own"),
        (["bench", "nope"], "neither a file nor a built-in"),
        (["record", "autec-1200", "--input", "step", "--out", "b", "--duration", "-3"], "above 0 s, but it is -3 s"),
        (["record", "autec-1200", "--input", "step", "--out", "b", "--duration", "inf"], "inf s"),
        (["fit", "autec-1200", "--model", "massless-linear", "--out", "b"], "--record"),
        (
            ["fit", "autec-1200", "--record", "a", "--model", "massless-linear", "--out", "b", "--budget", "0"],
            "--budget",
        ),
        (["crossval", "autec-1200", "--record", "a", "--out", "b", "--fraction", "1"], "below 1"),
        (["crossval", "autec-1200", "--record", "a", "--out", "b", "--fraction", "nan"], "nan"),
    ],
)
def test_bad_lines_end_in_one_error_line(
    line: list[str],
    words: str,
    called: dict[str, Any],
    capsys: Capture,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(line) == 2
    assert words in error_of(capsys)
    assert called == {}
    assert not list(tmp_path.iterdir())


def test_writing_over_an_input_is_refused(called: dict[str, Any], capsys: Capture, tmp_path: Path) -> None:
    trace = tmp_path / "trace.csv"
    trace.write_text("time_s\n")
    assert main(["simulate", "autec-1200", "--ship", str(trace), "--out", str(trace)]) == 2
    assert "files to read" in error_of(capsys)
    assert called == {}


@pytest.mark.parametrize("content", [b"", b"[cable\n", b"\xff\xfe", b"[cable]\nlength_m = -1\n"])
def test_broken_configuration_files(content: bytes, tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "broken [bold]x.toml"
    path.write_bytes(content)
    assert main(["run", str(path)]) == 2
    assert "broken [bold]x.toml" in error_of(capsys)
    assert main(["show", str(tmp_path)]) == 2
    assert "is a folder" in error_of(capsys)


@pytest.mark.parametrize(
    ("error", "code", "line"),
    [
        (InvalidInput("a [red]b[/red]\nc \x1b[1m"), 2, "error: a [red]b[/red] c \\x1b[1m\n"),
        (NumericalFailure("t = 3 s"), 1, "error: t = 3 s\n"),
        (PermissionError(13, "Permission denied", "x.csv"), 2, "error: x.csv: Permission denied.\n"),
        (KeyboardInterrupt(), 130, "error: interrupted.\n"),
        (BrokenPipeError(), 0, ""),
        (
            ZeroDivisionError("by 0"),
            1,
            "error: internal: ZeroDivisionError: by 0; set CABLE_IDENT_DEBUG=1 for the traceback.\n",
        ),
    ],
)
def test_exit_codes(
    error: BaseException, code: int, line: str, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("CABLE_IDENT_DEBUG", raising=False)
    monkeypatch.setattr("ident.exits._drop_output", lambda: None)

    def work() -> None:
        raise error

    assert exit_code(work) == code
    assert capsys.readouterr().err == line


def test_debug_gives_the_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CABLE_IDENT_DEBUG", "1")
    with pytest.raises(ZeroDivisionError):
        exit_code(lambda: 1 // 0 and None)


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="no POSIX signals here")
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_request_to_end_counts_as_an_interrupt(name: str, capsys: Capture) -> None:
    number = getattr(signal, name)
    before = signal.getsignal(number)

    def work() -> None:
        threading.Timer(0.05, lambda: os.kill(os.getpid(), number)).start()
        time.sleep(10.0)

    assert exit_code(work) == 130
    assert signal.getsignal(number) is before
    assert not interruption.is_set()
    assert capsys.readouterr().err == "error: interrupted.\n"


def test_help_and_version(capsys: Capture) -> None:
    assert main([]) == 0
    assert "crossval" in capsys.readouterr().out
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("cable-ident ")


def test_closed_output_is_quiet() -> None:
    code = "import sys; from ident.cli import main; sys.exit(main(['list']))"
    with subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert process.stderr.read() == ""
        assert process.wait() == 0


def test_progress_lines_are_few_and_never_fall(capsys: Capture) -> None:
    with progress(quiet=False) as report:
        for i in range(101):
            report("fitting a", i / 100)
            report("fitting b", i / 200)
    lines = capsys.readouterr().err.splitlines()
    percents = [int(line.split(" % ")[0]) for line in lines]
    assert lines[0] == "  0 % fitting a"
    assert percents == sorted(percents)
    assert percents[-1] == 100
    assert len(lines) <= 13
    with progress(quiet=True) as report:
        report("fitting a", 0.5)
    assert capsys.readouterr().err == ""


def test_table_on_a_terminal_shows_brackets(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True, raising=False)
    write_table([{"model": "[bold]a[/bold]", "rms": "0.1"}])
    assert "[bold]a[/bold]" in capsys.readouterr().out
    write_table([])
    assert capsys.readouterr().out == ""


def test_error_line_escapes_what_cannot_be_printed(capsys: Capture) -> None:
    write_error("caf\u00e9 \udc80\ttab")
    assert capsys.readouterr().err == "error: caf\u00e9 \\udc80\\ttab\n"
