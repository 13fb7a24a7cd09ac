"""Result files for MDAnalysis, whose own reader of H5MD knows no lengths in metres."""
from __future__ import annotations

from typing import Any

import MDAnalysis
import numpy as np
from MDAnalysis.coordinates.base import ReaderBase


class _Reader(ReaderBase):
    """Frames of a Result, read as they are asked for: positions in m, velocities in m/s, times in s."""

    format = "GRANPERI"
    units = {"time": None, "length": None, "velocity": None}

    def __init__(self, result: Any, **more: Any):
        super().__init__("granperi", convert_units=False)
        self._result = result
        self.n_frames, self.n_atoms = len(result), len(result[0].x)
        self._moves = result.has("vx")
        self.ts = self._Timestep(self.n_atoms, positions=True, velocities=self._moves, **self._ts_kwargs)
        self._read_frame(0)

    def _read_frame(self, frame: int) -> Any:
        if not 0 <= frame < self.n_frames:
            raise IOError(f"frame {frame}: there are {self.n_frames}")
        at, ts = self._result[frame], self.ts
        ts.positions = np.column_stack([at.x, at.y, np.zeros(self.n_atoms)])
        if self._moves:
            ts.velocities = np.column_stack([at.field("vx"), at.field("vy"), np.zeros(self.n_atoms)])
        ts.frame, ts.time = frame, at.time
        return ts

    def _read_next_timestep(self, ts: Any = None) -> Any:
        return self._read_frame(self.ts.frame + 1)

    def _reopen(self) -> None:
        self.ts.frame = -1

    def close(self) -> None:
        """The result is closed by whom it belongs to."""


def universe(result: Any) -> Any:
    """See Result.universe: result is a Result."""
    n = len(result[0].x)
    columns = result._read("column", 0) if result.has("column") else np.zeros(n, dtype=int)
    labels, segment = np.unique(columns, return_inverse=True)
    made = MDAnalysis.Universe.empty(n, n_residues=len(labels), atom_resindex=segment, trajectory=False)
    made.add_TopologyAttr("resid", labels)
    made.trajectory = _Reader(result)
    return made
