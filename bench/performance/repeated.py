"""The numbers of docs/performance.md that README and the guide repeat: (name, what it is, number)."""
from __future__ import annotations

import measures
import runs
from markdown import NONE, fixed
from peers import matter_run_outs
from results import Collection


def rows(results: Collection) -> list[tuple[str, str, str]]:
    found = [*_rates(results), *_memory(results), *_refinement(results), *_converged(results), *_exact(results), *_mpm()]
    minutes = sum(result.cpu for result in results.found.values()) / 60
    return [(f"performance.{name}", what, text) for name, what, text in found] + [
        ("performance.cpu_minutes", "CPU minutes of all runs", fixed(minutes, 0))
    ]


def _ends(values: list[float], digits: int) -> tuple[str, str]:
    return (fixed(min(values), digits), fixed(max(values), digits)) if values else (NONE, NONE)


def _rates(results: Collection) -> list[tuple[str, str, str]]:
    flows = [result for n in runs.FLOW if (result := results(runs.flow(n)))]
    least, most = _ends([1e3 / result.summary["cpu"] for result in flows], 1)
    found = [
        ("rate_least", "a collapse in flow, one thread: million particle-steps per CPU s, least", least),
        ("rate_most", "most", most),
    ]
    for n in runs.THREADS:
        result = results(runs.threads(n))
        size = f"{result.summary['particles']:.0f}" if result else f"{0.625 * n**2:.0f}"
        speed_up = fixed(result.summary["speed_up"] if result else None, 1)
        found.append((f"threads.width_{n}", f"speed-up of two threads, {size} particles", speed_up))
    return found


def _memory(results: Collection) -> list[tuple[str, str, str]]:
    largest, rest, flow = results(runs.growth(runs.GROWTH[-1])), results(runs.growth(400)), results(runs.flow(126))
    return [
        ("particles_most", "largest scene: million particles", fixed(largest.summary["particles"] / 1e6 if largest else None, 0)),
        ("bytes.large", "bytes per particle in it, of the library", fixed(largest.summary["bytes"] if largest else None, 0)),
        ("bytes.rest", "with 100 000 particles at rest", fixed(rest.summary["bytes"] if rest else None, 0)),
        ("bytes.flow", "with 10 000 particles in flow", fixed(flow.summary["bytes"] if flow else None, 0)),
    ]


def _refinement(results: Collection) -> list[tuple[str, str, str]]:
    """What half the spacing costs."""
    own = {n: result for n in runs.SCENES["a1.25"].resolutions if (result := results(runs.collapse("a1.25", n)))}
    ratios = [measures.cost(own[2 * n]) / measures.cost(own[n]) for n in own if n >= 16 and 2 * n in own]
    least, most = _ends(ratios, 1)
    return [
        ("refinement.least", "half the spacing, from L/dl = 16 to 128: CPU time, times, least", least),
        ("refinement.most", "most", most),
    ]


def _converged(results: Collection) -> list[tuple[str, str, str]]:
    """Against which docs/settings.md has its errors, too."""
    found = []
    for key, name in (("a1.25", "a125"), ("a5", "a5"), ("one_side", "one")):
        ref, scene = measures.reference(results, key), runs.SCENES[key]
        peak = ref.value["peak"] / scene.length if ref else None
        found += [(f"converged.{name}_peak", f"{scene.label}, finest: peak y/L", fixed(peak, 3)),
                  (f"converged.{name}_bulk", "run-out of 90 % of the mass", fixed(ref.value["bulk"] if ref else None, 3))]
    return found


def _exact(results: Collection) -> list[tuple[str, str, str]]:
    found = []
    for n in (10, 20):
        result = results(runs.exact("hydrostatic", n))
        error = f"{100 * result.summary['error']:.1f} %" if result else NONE
        found.append((f"hydrostatic.rows_{n}", f"layer of {n} rows at rest, default scheme: error of the pressure, of that at the base", error))
    return found


def _mpm() -> list[tuple[str, str, str]]:
    """Of the runs beside us in the figure."""
    least, most = _ends(matter_run_outs(), 2)
    return [
        ("mpm.bulk_least", "run-out of 90 % of the mass, explicit MPM with the same law, L/dl = 32 to 128: least", least),
        ("mpm.bulk_most", "most", most),
    ]
