"""The tables of docs/stability.md but for those of deposit.py."""
from __future__ import annotations

import math

import runs
import theory
from coefficients import NUMERICAL
from markdown import NONE, cpu, fixed, significant, signed, table
from measures import QUANTITIES, between, change, decay_rate, mean, root_mean_square, share_at_rest
from results import Collection, Result


def present(results: Collection) -> list[runs.Scheme]:
    """The schemes that this library has."""
    return [s for s in runs.SCHEMES.values() if results(runs.creep(s.key))]


# -------------------------------------------------------------------------------------------- time step


def _grades(result: Result | None) -> list[str]:
    if not result:
        return [NONE, NONE, NONE]
    cells = []
    for grade in ("same_deposit", "stable", "bounded"):
        beyond = math.isinf(result.summary[f"not_{grade}"])
        cells.append(f"{'≥ ' if beyond else ''}{result.summary[grade]:.2f}")
    return cells


def limits(results: Collection) -> str:
    """Along each axis, all schemes."""
    schemes = present(results)
    rows = []
    for axis in runs.AXES:
        for k, value in enumerate(axis.values):
            found = [results(axis.run(s.key, value)) if value in axis.of(s) else None for s in schemes]
            rows.append([axis.name if k == 0 else "", f"{value:g}", *(" / ".join(_grades(result)) for result in found)])
    return table(["axis", "value", *(f"{s.label}, L/dl = {s.limit_resolution}" for s in schemes)], rows)


def theory_of_layer(results: Collection) -> str:
    rows = []
    for s in present(results):
        if s.explicit_viscosity:
            continue
        cases = [(h, (0.1, 0.02), runs.limit(s.key, "layer", horizon=h)) for h in s.limit_horizons]
        if s.key == "default":
            cases += [(4, d, runs.limit(s.key, "layer", damping=d)) for d in runs.LIMIT_DAMPING]
        for horizon, damping, run in cases:
            _, calm, bounded = _grades(results(run))
            surface = theory.surface(horizon, *damping, s.shear_to_bulk)
            inside = theory.interior(horizon, *damping, s.shear_to_bulk)
            label = f"{s.label}, L/dl = {s.limit_resolution}"
            values = [f"{value:g}" for value in (horizon, *damping)]
            rows.append([label, *values, f"{surface:.2f}", calm, f"{inside:.2f}", bounded])
    return table(
        ["scheme", "horizon / dl", "bulk_viscosity", "penalty", "theory, free surface", "measured: calm to",
         "theory, inside", "measured: no energy made to"],
        rows,
    )  # fmt: skip


def theory_of_paper(results: Collection) -> str:
    rows = []
    for s in present(results):
        if not s.explicit_viscosity:
            continue
        for h in s.limit_horizons:
            result = results(runs.limit(s.key, "layer", horizon=h))
            sound = theory.number_density_interior(h if s.force_states else 4, 4 if s.force_states else h, s.force_states)
            _, calm, bounded = _grades(result)
            rows.append([f"{s.label}, {h:g} dl, L/dl = {s.limit_resolution}", f"{sound:.2f}", calm, bounded])
    return table(["scheme, radius", "theory, sound alone", "calm to", "no energy made to"], rows)


# ------------------------------------------------------------------------------------------------- creep


def creep(results: Collection) -> str:
    rows = []
    for s in present(results):
        tried = [(c, s.deltas[0], runs.creep(s.key, cfl=c)) for c in s.cfls]
        tried += [(s.own_cfl, d, runs.creep(s.key, delta=d)) for d in s.deltas[1:]]
        for cfl, delta, run in tried:
            result = results(run)
            if not result:
                continue
            spacing = runs.WIDTH / s.resolution
            dt = cfl * spacing / (s.wave_factor * result.summary["sound_speed"])
            effective = theory.effective_delta(math.tan(math.radians(21)), runs.GRAVITY, runs.HEIGHT / 4, spacing, dt)
            peaks = [result.at("peak_height", t) / runs.WIDTH for t in (runs.ARREST, 1, 3)]
            speed = root_mean_square(between(result, "rms_speed", 1, 3)) / math.sqrt(runs.GRAVITY * 0.002)
            rows.append(
                [
                    f"{s.label}, L/dl = {s.resolution}", f"{cfl:g}", f"{delta:g}",
                    significant(effective, 2) if s.explicit_viscosity else "",
                    *(fixed(p) for p in peaks), f"{signed(100 * (peaks[2] / peaks[0] - 1), 2)} %",
                    significant(speed, 2), f"{100 * abs(result.at('error_share', 3)):.1f} %", cpu(result.cpu),
                ]
            )  # fmt: skip
    return table(
        ["scheme", "cfl", "delta (1/s)", "dt mu p/(rho dl²) (1/s)", "peak y/L at 0.42 s", "1 s", "3 s", "0.42 to 3 s",
         "rms speed 1–3 s / √(g d)", "ledger error / E0 at 3 s", "CPU s"],
        rows,
    )  # fmt: skip


def drift(results: Collection) -> str:
    rows = []
    for s in runs.SCHEMES.values():
        for rest in runs.rests_of(s):
            result = results(rest.run)
            if not result:
                continue
            series = result.tables["series"]
            late = between(result, "drift", rest.end / 2, rest.end)
            rows.append(
                [
                    s.label, f"{rest.resolution}", f"{rest.cfl:g}", f"{rest.delta:g}" if s.drift_deltas else "",
                    f"{rest.end:g}", significant(series["drift"][-1], 2),
                    significant(series["drift_rms"][-1], 2), significant(float(late[-1] - late[0]), 2),
                    significant(series["kinetic_share"][-1], 2), f"{result.summary['steps']:.2g}", cpu(result.cpu),
                    significant(result.summary["particle_steps_rate"], 2),
                ]
            )  # fmt: skip
    return table(
        ["scheme", "L/dl", "cfl", "delta (1/s)", "to (s)", "largest / dl", "rms / dl", "largest, growth in the last half", "KE/E0 at the end",
         "steps", "CPU s", "particle-steps / CPU s"],
        rows,
    )  # fmt: skip


# ------------------------------------------------------------------------------------- pressure, zero energy

FLOW, REST = (0.05, 0.25), (0.6, 1.0)  # s


def coarse(results: Collection) -> str:
    """How many coarse deposits come to rest within a second, by the horizon."""
    rows = []
    for resolution in runs.COARSE_RESOLUTIONS:
        for diameter in runs.COARSE_DIAMETERS:
            found = [results(runs.coarse(resolution, diameter, h)) for h in runs.COARSE_HORIZONS]
            if any(found):
                resting = [f"{share_at_rest(r) * runs.MORE_SEEDS:.0f}" if r else NONE for r in found]
                rows.append([f"{resolution}", f"{diameter:g}", *resting])
    return table(["L/dl", "grain diameter (m)", *(f"horizon {h:g}" for h in runs.COARSE_HORIZONS)], rows) if rows else ""


def coarse_at_rest(results: Collection, resolution: int, horizon: float) -> tuple[int, int] | None:
    """Of all diameters: how many come to rest, and of how many."""
    found = [results(runs.coarse(resolution, d, horizon)) for d in runs.COARSE_DIAMETERS]
    if not all(found):
        return None
    return round(sum(share_at_rest(r) for r in found) * runs.MORE_SEEDS), len(found) * runs.MORE_SEEDS


def coarse_in_words(results: Collection) -> str:
    """Horizon 3 beside the default."""
    lines = []
    for resolution in runs.COARSE_RESOLUTIONS:
        three, four = (coarse_at_rest(results, resolution, h) for h in (3.0, 4.0))
        if three and four:
            lines.append(f"with L/dl = {resolution} {four[0]} of {four[1]} rest with horizon 4, {three[0]} with 3")
    return f"All diameters together: {'; '.join(lines)}." if lines else ""


def pressure_rows(results: Collection) -> list[tuple[str, Result]]:
    tried = [(f"{s.label}, L/dl = {s.resolution}", runs.creep(s.key)) for s in present(results)]
    tried += [(f"default, horizon {h:g} dl", runs.rough_horizon(h)) for h in runs.ROUGH_HORIZONS]
    tried += [(f"default, no {name}", runs.undamped(name)) for name in runs.UNDAMPED]
    return [(label, result) for label, run in tried if (result := results(run))]


def pressure(results: Collection) -> str:
    rows = []
    for label, result in pressure_rows(results):
        largest = [between(result, "max_pressure", *span) for span in (FLOW, REST)]
        noise = [100 * root_mean_square(between(result, "pressure_noise", *span)) for span in (FLOW, REST)]
        rows.append(
            [
                label, f"{result.tables['series']['max_pressure'].max():.2f}", f"{largest[0].mean():.2f}",
                f"{largest[1].mean():.2f}", f"{noise[0]:.1f} %", f"{noise[1]:.1f} %",
                cpu(result.cpu_to(1.0)),
            ]
        )  # fmt: skip
    return table(
        ["scheme", "highest p / (rho g H)", "mean of the highest, 0.05–0.25 s", "0.6–1 s", "noise, 0.05–0.25 s",
         "noise, 0.6–1 s", "CPU s per simulated s"],
        rows,
    )  # fmt: skip


def modes(results: Collection) -> str:
    rows = []
    for penalty in runs.MODE_PENALTIES:
        row = [f"{penalty:g}"]
        for pattern in runs.MODES:
            result = results(runs.mode(pattern, penalty))
            unit = result.summary["sound_speed"] * 32 / runs.WIDTH if result else math.nan
            row.append(significant(theory.checkerboard_decay(4, penalty, pattern), 2))
            row.append(significant(decay_rate(result) / unit, 2) if result else NONE)
        rows.append(row)
    header = ["penalty"]
    for pattern in runs.MODES:
        header += [f"{pattern}: theory (c0/dl)", "measured"]
    return table(header, rows)


def penalties(results: Collection) -> str:
    """What the penalty changes in the deposit."""
    rows = []
    base = results(runs.base_ensemble())
    c = next(one for one in NUMERICAL if one.option == "--penalty")
    for penalty in runs.PENALTIES:
        deposit = results(runs.varied(c, penalty))
        row = [f"{penalty:g}"]
        for column in ("peak", "bulk"):
            one = change(deposit, base, column) if deposit and base else None
            row.append("0" if penalty == c.default else one.text if one else NONE)
        row.append(f"{100 * deposit.summary['penalty_share']:.1f} %" if deposit else NONE)
        rows.append(row)
    return table(["penalty", "peak", "run-out, 90 %", "share of the dissipation"], rows)


# ------------------------------------------------------------------------------------------------- large


def resolution(results: Collection) -> str:
    rows = []
    for r, seeds in runs.RESOLUTIONS.items():
        result = results(runs.resolution_run(r))
        if not result:
            continue
        row = [f"{r}", f"{result.summary['particles']:.0f}", f"{seeds}"]
        for column in QUANTITIES:
            m = mean(result, column)
            value = m.value / (runs.WIDTH if column == "peak" else 1)
            error = 2 * m.error / (runs.WIDTH if column == "peak" else 1)
            row.append(f"{value:.3f}" + (f" ± {error:.3f}" if seeds > 1 else ""))
        row += [
            fixed(mean(result, "rest").value, 2), f"{100 * result.tables['seeds']['error'].max():.2f} %",
            cpu(result.cpu / seeds), significant(result.summary["particle_steps_rate"], 2),
        ]  # fmt: skip
        rows.append(row)
    return table(
        ["L/dl", "particles", "runs", "peak y/L", "run-out, 90 %", "run-out, 98 %", "at rest (s)", "ledger error / E0",
         "CPU s per run", "particle-steps / CPU s"],
        rows,
    )  # fmt: skip


def million(results: Collection) -> str:
    result = results(runs.million())
    if not result:
        return ""
    s = result.summary
    return (
        f"{s['particles']:.0f} particles, {s['steps']:.0f} steps (to {1000 * s['time']:.2f} ms): {cpu(s['cpu_seconds'])} CPU s, "
        f"{significant(s['particle_steps_rate'], 2)} particle-steps per CPU second, {s['memory'] / s['particles']:.0f} bytes "
        f"per particle ({s['memory'] / 1e6:.0f} MB), ledger error {100 * s['error']:.1e} % of E0."
    )
