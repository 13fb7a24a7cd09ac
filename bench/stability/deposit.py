"""The tables of docs/stability.md on what changes the deposit of a collapse."""
from __future__ import annotations

from pathlib import Path

import runs
from coefficients import COEFFICIENTS, FINE, NUMERICAL
from constants import CONSTANTS
from markdown import NONE, cpu, fixed, percent, table
from measures import QUANTITIES, change, changes, mean, same_bits, share_at_rest
from results import Collection


def scatter(results: Collection) -> str:
    """The yardstick: how far runs differ that differ by nothing."""
    rows = []
    for resolution in (8, 16, 32, 64):
        result = results(runs.resolution_run(resolution))
        if not result:
            continue
        row = [f"{resolution}", f"{runs.RESOLUTIONS[resolution]}"]
        for column in QUANTITIES:
            m = mean(result, column)
            unit = runs.WIDTH if column == "peak" else 1
            row += [fixed(m.value / unit, 3), f"{100 * m.scatter / m.value:.1f} %"]
        m = mean(result, "rest")
        row += [fixed(m.value, 2), f"{100 * m.scatter / m.value:.0f} %", cpu(result.cpu / runs.RESOLUTIONS[resolution])]
        rows.append(row)
    header = ["L/dl", "runs", "peak y/L", "scatter", "run-out, 90 %", "scatter", "run-out, 98 %", "scatter"]
    return table([*header, "at rest (s)", "scatter", "CPU s per run"], rows)


def criterion(results: Collection) -> str:
    rows = []
    for resolution in (32, 64):
        for c in NUMERICAL:
            if not c.in_criterion or (resolution == 64 and c.name not in FINE):
                continue
            found = {column: changes(results, c, resolution, column) for column in QUANTITIES}
            for k, value in enumerate((c.half, c.twice)):
                cells, verdicts = [], []
                for column in QUANTITIES:
                    known = [one for tried, one in found[column] if tried == value]
                    cells.append(known[0].text if known else NONE)
                    verdicts.append(known[0].verdict if known else NONE)
                label = c.name if k == 0 else ""
                rows.append(
                    [f"{label} {'' if k else f'(L/dl = {resolution})'}".strip(), f"{value:g}"]
                    + [cell for pair in zip(cells, verdicts) for cell in pair]
                )
    header = ["coefficient", "set to"]
    for name in QUANTITIES.values():
        header += [name, "verdict"]
    return table(header, rows)


def sensitivity(results: Collection) -> str:
    base = results(runs.base_ensemble())
    if not base:
        return ""
    rows = []
    for c in COEFFICIENTS:
        for k, value in enumerate(c.all_values):
            result = results(runs.varied(c, value))
            label = f"{c.name}{f' ({c.unit})' if c.unit else ''}" if k == 0 else ""
            mark = f"**{value:g}**" if value == c.default else f"{value:g}"
            if not result:
                rows.append([label, mark, *[NONE] * 6])
                continue
            seeds = len(result.tables["seeds"]["peak"])
            cells = [change(result, base, column).text for column in QUANTITIES]
            if value == c.default:
                cells = ["0"] * len(QUANTITIES)
            elif c.inert:
                same = "same bits" if same_bits(result, base) else "NOT the same bits"
                cells = [same] * len(QUANTITIES)
            at_rest = share_at_rest(result)
            rest = fixed(mean(result, "rest").value, 2) + (f" ({100 * at_rest:.0f} %)" if at_rest < 1 else "")
            error = f"{100 * result.tables['seeds']['error'].max():.2f} %"
            rows.append([label, mark, *cells, rest, error, cpu(result.cpu / seeds)])
    return table(
        ["coefficient", "value", *QUANTITIES.values(), "at rest (s)", "ledger error / E0", "CPU s per run"], rows
    )


def constants(results: Collection) -> str:
    """What half and twice an internal constant do."""
    base = results(runs.base_ensemble())
    rows = []
    for c in CONSTANTS:
        for k, value in enumerate(c.others):
            result = results(runs.by_constant(c, value))
            cells = [NONE] * len(QUANTITIES)
            if result and base:
                same = same_bits(result, base)
                cells = ["same bits" if same else change(result, base, column).text for column in QUANTITIES]
            rows.append([*((c.label, f"`{Path(c.file).name}`", c.own) if k == 0 else ("", "", "")), value, *cells])
    return table(["constant", "in", "as it is", "set to", *QUANTITIES.values()], rows)


def horizons(results: Collection) -> str:
    """Peak and run-outs by horizon and resolution against the finest of the default horizon."""
    finest = results(runs.resolution_run(runs.FINEST))
    rows = []
    for resolution in runs.HORIZON_RESOLUTIONS:
        for k, horizon in enumerate(runs.HORIZONS):
            result = results(runs.by_horizon(resolution, horizon))
            cells = []
            for column in QUANTITIES:
                m = mean(result, column) if result else None
                known = mean(finest, column) if finest else None
                cells += [
                    fixed(m.value / (runs.WIDTH if column == "peak" else 1)) if m else NONE,
                    percent(m.value, known.value) if m and known else NONE,
                ]
            pressure = fixed(mean(result, "pressure").value, 2) if result else NONE
            spent = cpu(result.cpu / len(result.tables["seeds"]["peak"])) if result else NONE
            rows.append([f"{resolution}" if k == 0 else "", f"{horizon:g}", *cells, pressure, spent])
    names = [cell for name in ("peak y/L", "run-out, 90 %", "run-out, 98 %") for cell in (name, "to the finest")]
    return table(["L/dl", "horizon / dl", *names, "highest p / (rho g H)", "CPU s per run"], rows)


def threads(results: Collection) -> str:
    one, two = (results(runs.threads_run(n)) for n in (1, 2))
    if not one or not two:
        return ""
    same = all(
        (one.tables["series"][name] == two.tables["series"][name]).all() for name in one.tables["series"]
    ) and same_bits(one, two)
    return (
        f"`threads`: with 1 and 2 the whole course of a collapse, {len(one.tables['series']['time'])} rows of "
        f"{len(one.tables['series'])} quantities, is {'the same in every digit' if same else '**not the same**'}."
    )


def recommended() -> str:
    rows = [[f"`{c.name}`", f"{c.default:g} {c.unit}".strip(), c.advice] for c in NUMERICAL]
    return table(["coefficient", "default", "recommended"], rows)


def dissipation(results: Collection) -> str:
    """Who takes the energy of the collapse with the defaults."""
    result = results(runs.base_ensemble())
    if not result:
        return ""
    names = {
        "friction": "friction", "collision": "collisions", "wall": "the extrapolation at plates",
        "penalty": "the zero-energy penalty", "diffusion": "density diffusion", "bulk": "bulk viscosity",
    }  # fmt: skip
    shares = {label: result.summary[f"{key}_share"] for key, label in names.items()}
    listed = ", ".join(f"{label} {100 * share:.1f} %" for label, share in shares.items())
    return f"Of the energy that the collapse dissipates (defaults, L/dl = 32, one run): {listed}."
