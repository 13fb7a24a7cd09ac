"""Sizes, offsets, constants and symbols of the low-level layer; names of the high-level one."""
import dataclasses
import re

import pytest
from conftest import ROOT
from granperi import _enums
from granperi._library import ffi, lib
from granperi._objects import Column, Config, Material
from granperi._plate import Plate

import granperi

PINNED = (ROOT / "tests/abi/layout.txt").read_text()
HEADER = re.sub(r"/\*.*?\*/", " ", (ROOT / "include/granperi/gp.h").read_text(), flags=re.S)


def test_sizes_are_those_of_the_abi():
    sizes = re.findall(r"^(gp_\w+) size (\d+)$", PINNED, re.M)
    assert len(sizes) >= 10
    for name, size in sizes:
        assert ffi.sizeof(name) == int(size), name


def test_offsets_are_those_of_the_abi():
    fields = re.findall(r"^(gp_\w+)\.(\w+) at (\d+) size (\d+)$", PINNED, re.M)
    assert len(fields) > 100
    for struct, field, offset, size in fields:
        assert ffi.offsetof(struct, field) == int(offset), (struct, field)
        assert ffi.sizeof(dict(ffi.typeof(struct).fields)[field].type) == int(size), (struct, field)


def test_constants_are_those_of_the_abi():
    constants = re.findall(r"^(GP_\w+) = (-?\d+)$", PINNED, re.M)
    assert len(constants) > 40
    for name, value in constants:
        assert getattr(lib, name) == int(value), name


def test_every_function_of_the_header_is_there():
    names = re.findall(r"^GP_API\s[^;(]*?\b(gp_\w+)\s*\(", HEADER, re.M)
    assert len(names) > 25
    for name in names:
        assert callable(getattr(lib, name)), name


@pytest.mark.parametrize("kind", [Config, Material, Column, Plate])
def test_keyword_objects_declare_every_field(kind):
    of_struct = [name for name, _ in ffi.typeof(kind._struct).fields if name not in ("struct_size", *kind._tables)]
    assert [name.rstrip("_") for name in kind.names()] == of_struct
    assert [name for name in kind.__annotations__ if not name.startswith("_")] == list(kind.names())


@pytest.mark.parametrize("kind, struct", [(granperi.State, "gp_state"), (granperi.Load, "gp_load")])
def test_read_objects_have_every_field(kind, struct):
    of_struct = [name for name, _ in ffi.typeof(struct).fields if name != "struct_size"]
    assert [field.name for field in dataclasses.fields(kind)] == of_struct


@pytest.mark.parametrize("kind, prefix", [
    (granperi.Preset, "GP_PRESET_"), (granperi.Stress, "GP_STRESS_"), (granperi.Density, "GP_DENSITY_"),
    (granperi.InitialPressure, "GP_INITIAL_"), (granperi.Wall, "GP_WALL_"), (granperi.Fluidity, "GP_FLUIDITY_"), (granperi.StepLimit, "GP_DT_"),
    (granperi.Field, "GP_FIELD_")])
def test_enumerations_are_complete(kind, prefix):
    in_library = {name[len(prefix):]: getattr(lib, name) for name in dir(lib) if name.startswith(prefix)}
    for group in ("POSITION", "VELOCITY", "ALL"):
        in_library.pop(group, None)
    assert {member.name: member.value for member in kind} == in_library


def test_every_status_has_an_exception():
    statuses = {name: getattr(lib, name) for name in dir(lib) if name.startswith("GP_E_")}
    kinds = {kind.status for kind in granperi.Error.__subclasses__()}
    assert kinds == set(statuses.values())


def test_version_is_that_of_the_header():
    version = ".".join(re.search(rf"GP_VERSION_{part} (\d+)", HEADER).group(1) for part in ("MAJOR", "MINOR", "PATCH"))
    assert granperi.__version__ == version


def test_field_groups_are_those_of_the_header():
    assert _enums.field_bits(_enums.field_names("position")) == lib.GP_FIELD_POSITION
    assert _enums.field_bits(_enums.field_names("velocity")) == lib.GP_FIELD_VELOCITY
    assert _enums.field_bits(_enums.field_names("all")) == lib.GP_FIELD_ALL


def test_every_field_says_what_it_is():
    assert tuple(_enums.FIELD_MEANINGS) == _enums.FIELD_NAMES
    for name, meaning in _enums.FIELD_MEANINGS.items():
        assert meaning in getattr(granperi.Simulation, name).__doc__
