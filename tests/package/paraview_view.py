#!/usr/bin/env python3
"""Opens a result file the way ParaView does and compares every frame with what the files say.

usage: paraview_view.py RUN.xdmf

Needs VTK with an XDMF reader: ParaView's own modules (Debian: python3-paraview) or the vtk wheel; Debian's python3-vtk9
is built without one. Compares the values too if h5py is there. Exits with 77 if there is no reader.
"""

import math
import os
import sys
import xml.etree.ElementTree as xml


def find_readers():
    readers = []
    for module, name in (("vtkIOXdmf2", "vtkXdmfReader"), ("vtkIOXdmf3", "vtkXdmf3Reader")):
        try:
            readers.append((name, getattr(__import__("vtkmodules." + module, fromlist=[name]), name)))
        except ImportError:
            pass
    return readers


def expect(condition, *what):
    if not condition:
        print("FAILED:", *what)
        sys.exit(1)


def listed_frames(path):
    """What the XDMF file lists: the HDF5 file, and for each frame (time, points, {array: components}, walls), where walls are
    (points, segments) or None."""
    frames = []
    hdf5_path = None
    for grid in xml.parse(path).getroot().iterfind("Domain/Grid/Grid"):
        arrays = {}
        points = 0
        time = float(grid.find("Time").get("Value"))
        lines = grid.find("Grid[@Name='walls']")
        walls = None
        if lines is not None:
            walls = (int(lines.find("Geometry/DataItem").get("Dimensions").split()[0]),
                     int(lines.find("Topology").get("NumberOfElements")))
            hdf5_path = os.path.join(os.path.dirname(path), lines.find("Geometry/DataItem").text.rsplit(":", 1)[0])
            grid = grid.find("Grid[@Name='particles']")
            if grid is None:
                frames.append((time, 0, {}, walls))
                continue
        geometry = grid.find("Geometry/DataItem")
        if geometry is not None:
            points = int(grid.find("Topology").get("NumberOfElements"))
            arrays[None] = 3
            hdf5_path = os.path.join(os.path.dirname(path), geometry.text.rsplit(":", 1)[0])
        for attribute in grid.iterfind("Attribute"):
            arrays[attribute.get("Name")] = {"Scalar": 1, "Vector": 3}[attribute.get("AttributeType")]
        frames.append((time, points, arrays, walls))
    return hdf5_path, frames


def flat(array):
    return [x for k in range(array.GetNumberOfTuples()) for x in array.GetTuple(k)]


def leaves(data):
    if not data.IsA("vtkMultiBlockDataSet"):
        return [data]
    return [leaf for k in range(data.GetNumberOfBlocks()) for leaf in leaves(data.GetBlock(k))]


def check_walls(data, walls, frame, where, stored):
    lines = leaves(data)[-1]
    expect((lines.GetNumberOfPoints(), lines.GetNumberOfCells()) == walls, where, "walls have",
           lines.GetNumberOfPoints(), "points and", lines.GetNumberOfCells(), "segments, not", walls)
    expect(lines.GetPointData().GetArray("plate") is not None, where, "walls do not name their plates")
    if stored is not None:
        expect(flat(lines.GetPoints().GetData()) == stored(frame, "walls"), where, "walls stand elsewhere")


def check(name, reader, path, frames, stored):
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as pipeline

    reader.SetFileName(path)
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(pipeline.TIME_STEPS()) or ()
    expect(list(times) == [frame[0] for frame in frames], name, "shows the times", times)
    for k, (time, points, arrays, walls) in enumerate(frames):
        reader.UpdateTimeStep(time)
        data = reader.GetOutputDataObject(0)
        where = "%s, frame %d:" % (name, k)
        all_points = points + (walls[0] if walls else 0)
        expect(data.GetNumberOfPoints() == all_points, where, data.GetNumberOfPoints(), "points, not", all_points)
        if walls:
            check_walls(data, walls, k, where, stored)
        if points == 0:
            continue
        while data.IsA("vtkMultiBlockDataSet"):
            data = data.GetBlock(0)
        expect(data.GetNumberOfCells() == points, where, data.GetNumberOfCells(), "cells, not", points)
        shown = data.GetPointData()
        expect(shown.GetNumberOfArrays() == len(arrays) - 1, where, shown.GetNumberOfArrays(), "arrays")
        for array, components in arrays.items():
            values = data.GetPoints().GetData() if array is None else shown.GetArray(array)
            expect(values is not None, where, "no array", array)
            expect(values.GetNumberOfComponents() == components, where, array, "has the wrong number of components")
            expect(values.GetNumberOfTuples() == points, where, array, "has", values.GetNumberOfTuples(), "values")
            numbers = flat(values)
            if components == 3:
                expect(not any(numbers[2::3]), where, array, "leaves the plane z = 0")
            if stored is not None:
                expect(all(a == b or (math.isnan(a) and math.isnan(b))
                           for a, b in zip(numbers, stored(k, array))), where, array, "differs from the HDF5 file")
    print("%s: %d frames of %d points, %s" % (name, len(frames), frames[0][1] if frames else 0,
                                               "values compared" if stored else "no values compared"))


def stored_values(hdf5_path):
    """Reads a frame from H5MD's own dataset and not through the view that ParaView uses; None without h5py."""
    if hdf5_path is None:
        return None
    try:
        import h5py
    except ImportError:
        return None
    hdf5 = h5py.File(hdf5_path, "r")
    elements = hdf5["particles/all"]

    def stored(frame, array):
        if array == "walls":
            return hdf5["frames/%06d/%06d/walls" % (frame - frame % 256, frame)][()].ravel().tolist()
        element = elements["position" if array is None else array]
        return (element["value"][frame] if isinstance(element, h5py.Group) else element[()]).ravel().tolist()

    return stored


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    readers = find_readers()
    if not readers:
        print("skipped: no vtk with an XDMF reader can be imported")
        return 77
    path = os.path.abspath(sys.argv[1])
    hdf5_path, frames = listed_frames(path)
    stored = stored_values(hdf5_path)
    for name, reader in readers:
        check(name, reader(), path, frames, stored)
    return 0


if __name__ == "__main__":
    sys.exit(main())
