"""The page of a response study: what the motion of a cable's top does to the vehicle, and how far to trust it."""

from pathlib import Path

import numpy as np
import pandas as pd

from reports import findings, response_findings, sections
from reports.figures import cable_motion, responses
from reports.markdown import Page, significant
from reports.response_material import ResponseMaterial
from reports.style import Album

#: A cable that turns by less than this along its length [degrees] has no mode shapes worth a picture.
STRAIGHT = 5.0


_NAMES = {
    "surge": "surge",
    "heave": "heave",
    "pitch": "pitch",
    "tension_bottom": "tension at the vehicle",
    "tension_top": "tension at the top",
}
_CONVENTIONS = {
    "run": "run",
    "surge_rad_s": "surge, rad/s",
    "surge_db": "dB",
    "heave_rad_s": "heave, rad/s",
    "heave_db": "dB",
    "tension_bottom_rad_s": "tension at the vehicle, rad/s",
    "tension_bottom_N": "N",
    "tension_top_rad_s": "tension at the top, rad/s",
    "tension_top_N": "N",
    "iterations": "iterations",
}
_THREE, _TWO = ".3f", ".2f"
_CONVENTION_FORMATS = {name: _THREE for name in _CONVENTIONS if name.endswith("rad_s")} | {
    "surge_db": _TWO,
    "heave_db": _TWO,
    "tension_bottom_N": ".0f",
    "tension_top_N": ".0f",
}


_SLOW = {"flow_m_s": "flow at the top, m/s", "consistent": "consistent", "printed": "as printed"}


def write_response_page(folder: Path, material: ResponseMaterial) -> None:
    """Write ``report.md`` and its ``figures`` into an existing folder."""
    page, album = Page(material.title), Album(folder)
    page.paragraph(material.description)
    page.paragraph(*response_findings.result(material))
    if len(material.printed):
        page.heading("Beside the paper")
        page.paragraph("What the paper prints of this case, and how far the first run is from it.")
        page.table(material.printed)
        page.paragraph(material.printed_words)
    _statics(page, album, material)
    _levels(page, album, material)
    _shapes(page, album, material)
    _along(page, album, material)
    _trust(page, album, material)
    if len(material.configuration):
        sections.configuration(page, material.configuration, material.left_out, material.unused)
    sections.manifest(page, material.manifest, material.configuration_text)
    page.write(folder / "report.md")


def _statics(page: Page, album: Album, material: ResponseMaterial) -> None:
    """The state that motions are counted from."""
    page.heading("Static state")
    page.table(material.state)
    picture = album.draw("static-shape", cable_motion.static_picture, material.statics, material.towed, material.parts)
    page.figure(
        picture, "Static shape to scale, seen from the side, and the static tension along the cable. Ship at the top."
    )


def _levels(page: Page, album: Album, material: ResponseMaterial) -> None:
    """Response curves, peaks and conventions."""
    page.heading("Response")
    marks = material.printed_marks
    page.figure(
        album.draw("response", responses.levels, material.curves, material.peaks, marks),
        "Motions of the vehicle over the amplitude of the cable's top: surge along its body, heave across it, pitch in "
        "dB over one radian a metre. Dots are the peaks of the table below, interpolated between the frequencies.",
    )
    first, last = (float(material.statics["tension_N"].iloc[i]) for i in (0, -1))
    if _changes(material):
        page.figure(
            album.draw("tensions", responses.tensions, material.curves, (first, last), material.peaks, marks),
            "Amplitude of the dynamic tension at both ends; a static tension that lies far above is not drawn.",
        )
    if len(material.peaks):
        chosen = response_findings.shown(material.peaks)
        shown = chosen.assign(quantity=chosen["quantity"].map(_NAMES))
        headings = {
            "quantity": "quantity",
            "omega_rad_s": "rad/s",
            "level": "amplitude",
            "unit": "unit",
            "level_db": "dB",
        }
        headings["prominence_db"] = "stands out by, dB"
        page.table(shown, headings, {"omega_rad_s": _THREE, "level_db": _TWO, "prominence_db": _TWO})
        if len(chosen) < len(material.peaks):
            more = findings.count(len(material.peaks) - len(chosen), "peak").capitalize()
            page.paragraph(
                f"{more} more than {response_findings.WEAK:g} dB below the highest of surge and heave: see `peaks.csv`."
            )
    page.heading("What it depends on", 3)
    page.paragraph(
        "The highest peaks of surge and heave and the first peaks of the tensions, with other conventions and "
        f"amplitudes. {material.conventions_words}"
    )
    page.table(material.conventions, _CONVENTIONS, _CONVENTION_FORMATS)


def _changes(material: ResponseMaterial) -> bool:
    """Whether the tension changes at all."""
    return float(material.slack_ratio.max()) >= response_findings.STEADY


def _shapes(page: Page, album: Album, material: ResponseMaterial) -> None:
    """Mode shapes of a cable that bends."""
    rows = [(f"{material.amplitude:g} m of motion", material.modes), ("Almost undamped", material.still_modes)]
    if not material.modes or float(np.degrees(np.ptp(material.statics["angle_rad"]))) < STRAIGHT:
        return
    page.heading("Mode shapes")
    page.figure(
        album.draw("mode-shapes", cable_motion.mode_shapes, rows),
        "Static shape (dotted) and the cable 90 (blue) and 270 degrees (red) after the crest of the input, at the "
        f"peaks of surge and heave of the almost undamped cable. Both rows are for {material.amplitude:g} m of motion "
        "of the top; the deflection is magnified as the titles say, five times as in the paper where that can be read.",
    )


def _along(page: Page, album: Album, material: ResponseMaterial) -> None:
    """Deflection, tension and slack along the cable."""
    page.heading("Along the cable")
    page.figure(
        album.draw("along", cable_motion.along_cable, material.at_peaks),
        "Amplitude of the deflection along and across the cable and of the dynamic tension, at the peaks of surge and "
        "heave; of whatever peaks where they do not, at three frequencies where nothing does.",
    )
    if not _changes(material):
        return
    page.figure(
        album.draw("slack", cable_motion.slack_map, material.slack_omega, material.slack_s, material.slack_ratio),
        "Dynamic over static tension; the dotted line is where the cable is nearest to slack"
        + (", inside the black line it is slack." if material.slack_ratio.max() >= 1.0 else "."),
    )


def _trust(page: Page, album: Album, material: ResponseMaterial) -> None:
    """Convergence, segments, and the digits of the product of matrices."""
    page.heading("How far to trust it")
    table = material.curves[0][1]
    missed = int((~table["converged"].astype(bool)).sum())
    page.paragraph(
        f"The damping is iterated at each frequency, {int(table['iterations'].max())} times at most; the last change, "
        f"the paper's norm, is at most {significant(float(table['change'].max()))}.",
        f"**{findings.count(missed, 'frequency' if missed == 1 else 'frequencie').capitalize()} did not converge.**"
        if missed
        else "",
    )
    page.paragraph(*_fineness(material.bends))
    names = [str(name) for name in material.errors.columns if name != "omega_rad_s"]
    if names:
        worst = float(material.errors[names].to_numpy(dtype=float).max())
        page.paragraph(
            "The error that these segments leave, estimated with half as many, is at most "
            f"{significant(100.0 * worst)} % of a quantity's largest amplitude."
        )
    if len(material.refinement):
        shown = material.refinement.rename(columns={name: _NAMES.get(str(name), str(name)) for name in names})
        page.figure(
            album.draw("segments", responses.segments, material.bends, material.errors, material.refinement),
            "Turn of each segment; estimated error over frequency; largest error of coarser runs against one of four "
            "times the segments.",
        )
        page.table(shown, formats={"segments": ".0f", "order": _TWO})
    if len(material.kept):
        _digits(page, album, material)
    if len(material.slow):
        _slow(page, material.slow)


def _slow(page: Page, table: pd.DataFrame) -> None:
    """The limit of slow motion by both forms of the drag."""
    page.heading("Slow motion", 3)
    page.paragraph(
        "A top that moves ever more slowly leaves the tow in the steady shape of its speed: the part of the dynamic "
        "tension in phase with the velocity must become the derivative of the static tension by the flow. How far it "
        "is from that, over the largest derivative along the cable, with the drag of the moved angle (consistent; what "
        "is left is the mesh's) and with that of the static angle (as the paper prints it):"
    )
    page.table(table, _SLOW, {"flow_m_s": ".3g", "consistent": ".1e", "printed": ".2g"})


def _fineness(bends: pd.DataFrame) -> list[str]:
    """How long the segments are, and how much the one that turns most turns."""
    length, turn = bends["segment_m"].to_numpy(dtype=float), bends["turn_deg"].to_numpy(dtype=float)
    sizes = f"{significant(float(length.min()))} to {significant(float(length.max()))} m"
    i = int(turn.argmax())
    sentences = [f"The cable has {length.size} segments of {sizes}."]
    if turn[i] > 1e-3:
        sentences.append(
            f"Where a segment turns most, {float(bends['s_m'].iloc[i]):.1f} m from the vehicle, it is "
            f"{significant(float(length[i]))} m long and turns by {significant(float(turn[i]))} degrees, its length "
            "times the curvature."
        )
    return sentences


def _digits(page: Page, album: Album, material: ResponseMaterial) -> None:
    """Where the printed product of matrices fails and the stable solve does not."""
    page.heading("The product of matrices", 3)
    own, kept = material.agreement, material.kept["digits"]
    lost = own.loc[own["digits"] < 1.0, "omega_rad_s"]
    page.paragraph(
        "The paper multiplies the matrices of all segments. Where the cable leans, entries that grow with the damping "
        "of lateral waves drown the others: the digits left are 16 less the powers of ten by which terms cancel at the "
        "top. The stable solve carries the same equations with the directions kept apart.",
        "In still water this cable hangs straight and nothing mixes; all of this is for a current of "
        f"{material.flow:g} m/s."
        if material.flow
        else "",
    )
    page.paragraph(
        f"At the length and drag of the configuration the product keeps {own['digits'].min():.1f} to "
        f"{own['digits'].max():.1f} digits"
        + (f", less than one from {lost.min():.3g} rad/s on;" if len(lost) else ";"),
        f"the stable solve keeps at least {own['stable'].min():.1f} over the whole range.",
        f"On the map of lengths, frequencies and drags the product keeps less than one digit in "
        f"{int((kept < 1.0).sum())} of {int(kept.notna().sum())} cases.",
    )
    page.figure(
        album.draw("digits", responses.digits, material.kept, own, material.lengths_of),
        "Above, digits that the product keeps over length, frequency and normal drag coefficient, with "
        f"{material.map_segments} segments (fewer keep more, but no longer resolve the waves that grow); grey where "
        "there is no static shape. Below, at the length and drag of the configuration: the same, those of the stable "
        "solve by its own rounding, and those that both share in heave and tension, none where the product is refused.",
    )
