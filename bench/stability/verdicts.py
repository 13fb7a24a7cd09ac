"""What the runs say in words: the head of docs/stability.md and what each preset cannot do."""
from __future__ import annotations

import math

import numpy as np

import runs
import theory
from coefficients import CRITERION, NUMERICAL, Coefficient
from constants import CONSTANTS
from markdown import significant
from measures import QUANTITIES, Change, between, change, changes, mean, root_mean_square, share_at_rest
from results import Collection, Result
from sections import FLOW, REST, present

CREEPS = 0.005  # of the peak, between arrest and 3 s


def _percent(value: float, digits: int = 1) -> str:
    return f"{100 * value:.{digits}f} %"


def criterion(results: Collection) -> list[str]:
    """Whether no coefficient changes the deposit by more than the criterion, and where it does."""
    tried = [c for c in NUMERICAL if c.in_criterion]
    if not results(runs.base_ensemble()):
        return []
    lines = []
    for column, label in QUANTITIES.items():
        known = {c.name: changes(results, c, 32, column) for c in tried}
        if not all(known.values()):
            continue
        passed = [name for name, found in known.items() if all(one.verdict == "passes" for _, one in found)]
        failed = [
            f"{name} at {value:g} ({one.text})"
            for name, found in known.items()
            for value, one in found
            if one.verdict == "FAILS"
        ]
        open_ones = [
            f"{name} at {value:g} ({one.text})"
            for name, found in known.items()
            for value, one in found
            if "doubt" in one.verdict
        ]
        text = f"{label}: {'holds' if not failed and not open_ones else 'does not hold' if failed else 'not decided'}"
        text += f"; passes for {', '.join(passed) or 'none'}"
        if failed:
            text += f"; **fails for {', '.join(failed)}**"
        if open_ones:
            text += f"; within the doubt of the means for {', '.join(open_ones)}"
        lines.append(text + ".")
    return lines


HEADLINE = ("peak", "bulk")  # that the first paragraph is about


def constants(results: Collection) -> str:
    """The same of those that are no settings."""
    base = results(runs.base_ensemble())
    found = [(c, value, results(runs.by_constant(c, value))) for c in CONSTANTS for value in c.others]
    if not base or not all(result for *_, result in found):
        return ""
    beyond = [
        f"`{c.name}` {value} ({QUANTITIES[column]} {one.text})"
        for column in HEADLINE
        for c, value, result in found
        if abs((one := change(result, base, column)).value) > CRITERION
    ]
    return f"Peak and run-out of 90 % of the mass change by less than {100 * CRITERION:g} %" + (
        f", but for {', '.join(beyond)}." if beyond else "."
    )


def in_short(results: Collection) -> str:
    """The paragraph that the report begins with."""
    parts = (_criterion_in_short, _scatter, _horizon_in_short, _rest, _step)
    return " ".join(text for text in (part(results) for part in parts) if text)


def _changes(results: Collection) -> list[tuple[str, Coefficient, float, Change]]:
    """What the coefficients of the criterion do: quantity of the headlines, coefficient, value, change."""
    return [
        (column, c, value, one)
        for column in HEADLINE
        for c in NUMERICAL
        if c.in_criterion
        for value, one in changes(results, c, 32, column)
    ]


def _criterion_in_short(results: Collection) -> str:
    """What half and twice a coefficient do to the deposit."""
    known = _changes(results)
    if {column for column, *_ in known} != set(HEADLINE):
        return ""
    within = f"Half or twice a coefficient of the scheme changes the deposit of a collapse (L/dl = 32) by less than {100 * CRITERION:g} %"
    beyond = [
        f"{c.name} {value:g} ({QUANTITIES[column]} {one.text})"
        for column, c, value, one in known
        if abs(one.value) > CRITERION
    ]
    return f"**{within}{', but for ' + ', '.join(beyond) if beyond else ': peak and run-out of 90 % of the mass'}.**"


def beyond(results: Collection) -> str:
    """Names and values of what changes the headlines by more than the criterion, for the pages."""
    found = {(c.name, value) for _, c, value, one in _changes(results) if abs(one.value) > CRITERION}
    names = [c.name for c in NUMERICAL if any(c.name == name for name, _ in found)]
    return ", ".join(f"`{name}` {' and '.join(f'{value:g}' for own, value in sorted(found) if own == name)}" for name in names)


def _scatter(results: Collection) -> str:
    base = results(runs.base_ensemble())
    if not base:
        return ""
    scatter = ", ".join(
        f"{_percent(mean(base, column).scatter / mean(base, column).value)} ({QUANTITIES[column]})" for column in HEADLINE
    )
    return f"Runs that differ by a jitter of {runs.JITTER:g} dl alone differ by {scatter}: less cannot be told from a single run."


def _horizon_in_short(results: Collection) -> str:
    """From which to which, against the finest run, from L/dl = 32 on."""
    finest = results(runs.resolution_run(runs.FINEST))
    found = [results(runs.by_horizon(r, h)) for r in runs.HORIZON_RESOLUTIONS if r >= 32 for h in runs.HORIZONS]
    if not finest or not all(found):
        return ""
    most = [max(abs(mean(r, column).value / mean(finest, column).value - 1) for r in found) for column in HEADLINE]
    return (
        f"With horizons from {runs.HORIZONS[0]:g} to {runs.HORIZONS[-1]:g} dl and L/dl from 32 on the peak is within {_percent(most[0])} of "
        f"that of the finest run, the run-out of 90 % of the mass within {_percent(most[1])}."
    )


def _rest(results: Collection) -> str:
    rests = [rest for rest in runs.rests_of(runs.SCHEMES["default"]) if rest.cfl == rest.scheme.own_cfl]
    found = [(rest, result) for rest in rests if (result := results(rest.run))]
    if not found:
        return ""
    most = max(result.tables["series"]["drift"][-1] for _, result in found)
    return (
        f"A deposit stays where it is: from {runs.DRIFT_FROM:g} to {found[0][0].end:g} s no particle moves by more than "
        f"{significant(most, 2)} dl."
    )


def own_steps(results: Collection) -> tuple[float, float] | None:
    """The library's own, least and most on average between two rows of a collapse, in dl / wave speed."""
    scheme = runs.SCHEMES["default"]
    result = results(runs.creep("default"))
    if not result:
        return None
    series = result.tables["series"]
    steps = np.diff(series["time"]) / np.diff(series["steps"])
    unit = runs.WIDTH / scheme.resolution / (scheme.wave_factor * result.summary["sound_speed"])
    return float(steps.min() / unit), float(steps.max() / unit)


def _step(results: Collection) -> str:
    step, layer, own = results(runs.limit("default", "collapse")), results(runs.limit("default", "layer")), own_steps(results)
    if not step or not layer or not own:
        return ""
    return (
        f"The time step could be longer: counted in dl / wave speed a layer stays calm up to {layer.summary['stable']:.2f}, a collapse up to "
        f"{step.summary['stable']:.2f}; the library's own are {own[0]:.2f} in quick motion to {own[1]:.2f} at rest, on average from one row "
        "of a collapse to the next."
    )


def against_theory(results: Collection) -> str:
    """How far von Neumann's analysis is off."""
    horizons = runs.SCHEMES["default"].limit_horizons
    cases = [
        (results(runs.limit("default", "layer", horizon=h)), theory.surface(h), theory.interior(h))
        for h in horizons
    ]
    calm = [r.summary["stable"] / surface - 1 for r, surface, _ in cases if r]
    bounded = [r.summary["bounded"] / inside - 1 for r, _, inside in cases if r]
    if not calm:
        return ""
    return (
        f"With horizons of {horizons[0]:g} to {horizons[-1]:g} dl the layer stays calm up to steps that are "
        f"{100 * min(calm):+.0f} to {100 * max(calm):+.0f} % off von Neumann's analysis beside a free surface, and makes no energy up to "
        f"steps {100 * min(bounded):+.0f} to {100 * max(bounded):+.0f} % off that of the interior."
    )


def _creep_line(results: Collection, key: str) -> str:
    result = results(runs.creep(key))
    if not result:
        return ""
    peaks = [result.at("peak_height", t) for t in (runs.ARREST, 3)]
    speed = root_mean_square(between(result, "rms_speed", 1, 3)) / math.sqrt(runs.GRAVITY * 0.002)
    error = abs(result.at("error_share", 3))
    change = peaks[1] / peaks[0] - 1
    return (
        f"it {'creeps' if abs(change) > CREEPS else 'comes to rest'}: the peak changes by {100 * change:+.2f} % from {runs.ARREST:g} to 3 s, the rms "
        f"speed left is {significant(speed, 2)} √(g d), and {_percent(error)} of E0 are unaccounted for by 3 s"
    )


def _noise_line(result: Result) -> str:
    flow, rest = (100 * root_mean_square(between(result, "pressure_noise", *span)) for span in (FLOW, REST))
    return (
        f"its pressure is {flow:.1f} % of rho g H off its neighbours' plane while it flows and {rest:.1f} % afterwards "
        f"(highest pressure {result.tables['series']['max_pressure'].max():.1f} rho g H)"
    )


def cannot(results: Collection) -> list[str]:
    """What each preset cannot do, from what was measured."""
    lines = []
    for s in present(results):
        result = results(runs.creep(s.key))
        delta = "" if s.delta_option is None else f", delta {s.delta_option:g} 1/s"
        lines.append(f"**{s.label}, L/dl = {s.resolution}{delta}**: {_creep_line(results, s.key)}; {_noise_line(result)}.")
    for horizon in runs.ROUGH_HORIZONS:
        result = results(runs.rough_horizon(horizon))
        if result:
            lines.append(f"**default, horizon {horizon:g} dl**: {_noise_line(result)}.")
    late = []
    for c in NUMERICAL:
        for value in c.values:
            result = results(runs.varied(c, value))
            if result and share_at_rest(result) < 1:
                late.append(f"{c.name} {value:g} ({_percent(1 - share_at_rest(result), 0)} of the runs)")
    if late:
        lines.append(f"**default, not at rest by 1 s**: {', '.join(late)}.")
    return lines

