"""Constants of the engine that are no settings, with the values that are tried: half, as it is, twice."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Constant:
    name: str  # in the source
    file: str
    values: tuple[str, str, str]  # as the source writes them; of a bound above 1, what is above it
    label: str

    @property
    def own(self) -> str:
        return self.values[1]

    @property
    def others(self) -> tuple[str, str]:
        return self.values[0], self.values[2]

    def changed(self, root: Path, value: str) -> bytes:
        """Its file with another value."""
        text = (root / self.file).read_text(encoding="utf-8")
        words = [f"{self.name} = {self.own}{end}" for end in ";,"]
        found = [word for word in words if word in text]
        if len(found) != 1 or text.count(found[0]) != 1:
            raise SystemExit(f"{self.file} does not have {self.name} = {self.own} once: bench/stability/constants.py")
        return text.replace(found[0], f"{self.name} = {value}{found[0][-1]}").encode()


# Those that a collapse on a rough floor could depend on, each in one file that is compiled. operators.hpp has those of few
# grains, whose figures stand there.
CONSTANTS = (
    Constant("spacing_strain", "src/stages/density_of_spacing.cpp", ("1.5", "3", "6"), "strain in which the density follows the spacing"),
    Constant("spacing_ceiling", "src/stages/density_of_spacing.cpp", ("1.025", "1.05", "1.1"), "most that crowding makes of the density, over ρ0"),
    Constant("moment_of_disorder", "src/stages/crowding.hpp", ("0.02", "0.04", "0.08"), "squared first moment that is no free surface yet"),
    Constant("full_crowding", "src/stages/collide.cpp", ("0.05", "0.1", "0.2"), "crowding from which collisions move all of it"),
    Constant("steepest_tangential", "src/stages/wall_extrapolation.cpp", ("0.25", "0.5", "1"), "steepest ratio of a ghost's tangential velocity away from yield"),
    Constant("normal_ratio", "src/stages/wall_extrapolation.cpp", ("0.125", "0.25", "0.5"), "ratio of a ghost's normal velocity"),
    Constant("least_elastic_penalty", "src/scene_constants.cpp", ("0.1", "0.2", "0.4"), "least penalty inside the yield surface"),
    Constant("pressure_memory", "src/scene_constants.cpp", ("50", "100", "200"), "dl/c0 over which the pressure of the inertial number is averaged"),
    Constant("shear_to_bulk", "src/scene_constants.cpp", ("0.15", "0.3", "0.6"), "shear modulus over bulk modulus"),
)  # fmt: skip
