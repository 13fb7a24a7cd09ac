"""Bodies of other shapes: polygons and masks."""
import numpy as np
import pytest

import granperi


def filled(call, *arguments, spacing=0.005, **more):
    with granperi.Simulation(spacing=spacing) as sim:
        getattr(sim, call)(*arguments, **more)
        return sim.particles("position", "velocity", "column")


def sorted_places(particles):
    return np.array(sorted(zip(particles.x.round(12), particles.y.round(12))))


def test_a_rectangle_is_a_column():
    column = filled("add_column", x_min=0.01, y_min=0.02, width=0.1, height=0.05)
    corners = [[0.01, 0.02], [0.11, 0.02], [0.11, 0.07], [0.01, 0.07]]
    for points in (corners, corners[::-1], [*corners, corners[0]]):
        assert np.allclose(sorted_places(filled("add_polygon", points)), sorted_places(column), atol=1e-12)
    mask = filled("add_mask", np.ones((5, 10), bool), 0.01, 0.02, 0.1)
    assert np.allclose(sorted_places(mask), sorted_places(column), atol=1e-12)


@pytest.mark.parametrize("points, area", [
    ([[0, 0], [0.2, 0], [0.1, 0.15]], 0.015),  # triangle
    ([[0, 0], [0.2, 0], [0.2, 0.1], [0.1, 0.02], [0, 0.1]], 0.012),  # concave
    ([[0, 0], [0.1, 0.1], [0.1, 0], [0, 0.1]], 0.005),  # crosses itself
])
def test_the_mass_is_that_of_the_area(points, area):
    spacing = 0.001
    n = len(filled("add_polygon", points, spacing=spacing).x)
    length = sum(np.hypot(*np.subtract(a, b)) for a, b in zip(points, points[1:] + points[:1]))
    assert abs(n * spacing**2 - area) < 0.5 * length * spacing  # the lattice cuts the edges by less than half a spacing


def test_a_mask_has_its_first_row_at_the_top_and_a_velocity():
    particles = filled("add_mask", [[1, 0], [1, 1]], 0.0, 0.0, 0.1, vx=0.2, vy=-0.1)
    assert len(particles.x) == 3 * 100 and not np.any((particles.x > 0.05) & (particles.y > 0.05))
    assert np.all(particles.vx == 0.2) and np.all(particles.vy == -0.1)


def test_an_image_is_material_where_it_is_dark(tmp_path):
    Image = pytest.importorskip("PIL.Image")
    pixels = np.full((20, 40), 255, np.uint8)
    pixels[:, :10] = 0
    Image.fromarray(pixels).save(tmp_path / "m.png")
    particles = filled("add_mask", tmp_path / "m.png", -0.1, 0.0, 0.4)
    assert particles.x.max() < 0 and len(particles.x) == 20 * 40
    transparent = np.zeros((4, 4, 4), np.uint8)  # black, but nothing of it is to be seen
    transparent[:, 0, 3] = 255
    Image.fromarray(transparent, "RGBA").save(tmp_path / "t.png")
    assert filled("add_mask", tmp_path / "t.png", 0, 0, 0.4).x.max() < 0.1


def test_shapes_in_a_scene_file(tmp_path):
    (tmp_path / "outline.csv").write_text("x,y\n0,0\n0.1,0\n0.05,0.1\n")
    (tmp_path / "s.toml").write_text("""
[config]
spacing = 0.005
[[material]]
name = "fine"
grain_diameter = 0.001
[[polygon]]
file = "outline.csv"
material = "fine"
[[mask]]
mask = [[0, 1], [1, 1]]
x_min = 0.2
y_min = 0.0
width = 0.1
vx = -0.5
""")
    scene = granperi.Scene.read(tmp_path / "s.toml")
    (tmp_path / "elsewhere").mkdir()
    scene.write(tmp_path / "elsewhere" / "w.toml")
    for one in (scene, granperi.Scene.read(tmp_path / "elsewhere" / "w.toml")):
        with one.build() as sim:
            fine = sim.column == 0
            assert fine.sum() == pytest.approx(0.005 / 0.005**2, rel=0.1) and (~fine).sum() == 300
            assert sim.vx[~fine].max() == -0.5 and sim.vx[fine].max() == 0
        with one.build(spacing=0.0025) as sim:
            assert (sim.column == 1).sum() == 1200
