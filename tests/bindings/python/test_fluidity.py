"""Granular fluidity: materials, plates, the field, scene files, result files, checkpoints, pictures."""
import numpy as np
import pytest
from conftest import needs_hdf5

import granperi

SCENE = """\
[config]
spacing = 0.01
threads = 1
sound_speed = 8.0
periodic_x_max = 0.12
[[material]]
name = "beads"
grain_diameter = 0.02
nonlocal_amplitude = 0.48
fluidity_time = 2e-4
[[column]]
width = 0.12
height = 0.08
material = "beads"
[[floor]]
x_left = 0.0
x_right = 0.12
fluidity = "zero"
[[plate]]
x0 = 0.0
y0 = 0.08
x1 = 0.12
y1 = 0.08
vx = 0.02
normal_pressure = 400.0
"""


def sheared(steps=100, **material):
    """A layer between a floor that holds its grains and a lid that drags it slowly, periodic in x."""
    sim = granperi.Simulation(spacing=0.01, threads=1, sound_speed=8, periodic_x_max=0.12)
    beads = sim.add_material(**{"grain_diameter": 0.02, "nonlocal_amplitude": 0.48, "fluidity_time": 2e-4, **material})
    sim.add_column(width=0.12, height=0.08, material=beads)
    sim.add_plate(granperi.Plate.floor(0, 0.12, fluidity="zero"))
    sim.add_plate(y0=0.08, x1=0.12, y1=0.08, vx=0.02, normal_pressure=400)
    sim.step(steps)
    return sim


def test_it_is_off_by_default():
    assert granperi.Material().nonlocal_amplitude == 0 and granperi.Material().fluidity_time == 1e-4
    assert granperi.Plate().fluidity is granperi.Fluidity.FREE


def test_a_plate_takes_it_by_member_name_or_number():
    for given in (granperi.Fluidity.ZERO, "zero", "ZERO", 1):
        assert granperi.Plate(fluidity=given).fluidity is granperi.Fluidity.ZERO
    with pytest.raises(granperi.ArgumentError, match="gp_plate.fluidity = 'zeros': did you mean 'zero'.*free, zero"):
        granperi.Plate(fluidity="zeros")
    with pytest.raises(granperi.ArgumentError, match="gp_plate.fluidity = 2: expected a whole number from 0 to 1"):
        granperi.Simulation(threads=1).add_plate(x1=1, fluidity=2)


def test_ranges_are_the_library_s():
    with pytest.raises(granperi.ArgumentError, match="gp_material.nonlocal_amplitude = 11: expected a number from 0 to 10"):
        granperi.Simulation(threads=1).add_material(nonlocal_amplitude=11)
    with pytest.raises(granperi.UnsupportedError, match="gp_material.nonlocal_amplitude"):
        granperi.Simulation(granperi.Config("paper", threads=1)).add_material(nonlocal_amplitude=0.48)


def test_the_field_is_read_like_any_other():
    with sheared() as sim:
        fluidity = sim.fluidity
        assert fluidity.shape == (96,) and fluidity.max() > 0 and (fluidity >= 0).all()
        assert np.array_equal(sim.particles().fluidity, fluidity)
        view = sim.view("id", "fluidity")
        assert np.array_equal(np.asarray(view.fluidity)[np.argsort(np.asarray(view.id))], fluidity)
        assert granperi.Field.FLUIDITY in granperi.Field(0xFFFF) and "1/s" in granperi.Simulation.fluidity.__doc__
    with sheared(nonlocal_amplitude=0) as local:
        assert not local.fluidity.any()


def test_a_coarse_spacing_is_warned_of():
    with pytest.warns(granperi.GranperiWarning, match="set gp_config.spacing to at most 0.005"):
        sheared(1, grain_diameter=0.01).close()


def test_a_scene_file_has_it():
    with granperi.Scene.parse(SCENE).build() as sim, sheared() as same:
        assert sim.materials == same.materials and sim.plates == same.plates
        sim.step(100)
        assert np.array_equal(sim.fluidity, same.fluidity)
    wrong = SCENE.replace('fluidity = "zero"', 'fluidity = "none"')
    with pytest.raises(granperi.SceneError, match=r"\[\[floor\]\] number 1: gp_plate.fluidity = 'none'"):
        granperi.Scene.parse(wrong).build()


@needs_hdf5
def test_result_files_and_checkpoints_keep_it(tmp_path):
    with sheared() as sim:
        with sim.output(tmp_path / "run.h5", fields=("position", "fluidity")) as output:
            output.write()
        with granperi.Result(tmp_path / "run.h5") as result:
            assert np.array_equal(result[-1].field("fluidity"), sim.fluidity)
            assert result.scene["materials"][1]["nonlocal_amplitude"] == 0.48
        sim.save(tmp_path / "state.gp")
        with granperi.load(tmp_path / "state.gp") as loaded:
            assert loaded.materials == sim.materials and loaded.plates == sim.plates
            sim.step(20)
            loaded.step(20)
            assert np.array_equal(loaded.fluidity, sim.fluidity)


def test_a_picture_has_its_unit_and_a_logarithmic_scale():
    plot = pytest.importorskip("granperi.plot")
    with sheared(300) as sim:
        axes = plot.field(sim, "fluidity")
        bar, = (other for other in axes.figure.axes if other is not axes)
        assert bar.get_ylabel() == "fluidity g (1/s)" and bar.get_yscale() == "log"
