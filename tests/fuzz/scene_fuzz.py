#!/usr/bin/env python3
"""Scene files at random: files of the corpus with bytes, lines, keys and values changed, read as `python3 -m granperi run`
does. Each is a scene or a granperi.SceneError (or another granperi.Error) with a text; no other exception. Deterministic.

    scene_fuzz.py CORPUS [--seconds S] [--seed N]      ends with the count, and how many lines of _scene*.py were reached
"""
import argparse
import pathlib
import random
import sys
import time
import warnings

import granperi
from granperi import _scene, _scene_tables

HOSTILE = ["nan", "inf", "-inf", "1e308", "-1", "0", "5e-324", "9223372036854775807", "99999999999999999999", '""', '"\\u0000"',
           "[]", "{}", "[1, 'a']", "true", "1979-05-27", "'x'", "[[1.0]]", '"fine"', "[nan, 1.0]", "1_0", "0x10"]
KINDS = ["config", "run", "[material]", "[column]", "[particles]", "[polygon]", "[mask]", "[floor]", "[gate]", "[wall]", "[wall_line]",
         "[plate]", "[probe]", "nothing", "a.b"]


def mutate(text: bytes, other: bytes, rng: random.Random) -> bytes:
    for _ in range(rng.choice((1, 1, 1, 2, 4))):
        lines = text.split(b"\n")
        at = rng.randrange(len(lines))
        what = rng.randrange(9)
        if what == 0 and text:
            k = rng.randrange(len(text))
            text = text[:k] + bytes([rng.randrange(256)]) + text[k + 1:]
            continue
        if what == 1 and text:
            k, n = rng.randrange(len(text)), rng.randint(1, 30)
            text = text[:k] + text[k + n:]
            continue
        if what == 2:
            del lines[at]
        elif what == 3:
            lines.insert(at, rng.choice(other.split(b"\n")))
        elif what == 4 and rng.random() < 0.3:
            lines.insert(at, b"[" + rng.choice(KINDS).encode() + b"]")
        elif what == 5:
            lines.insert(at, lines[rng.randrange(len(lines))])
        else:
            key = lines[at].split(b"=")[0]
            lines[at] = key + b"= " + rng.choice(HOSTILE).encode()
        text = b"\n".join(lines)
    return text


def too_large(scene: granperi.Scene) -> bool:
    """Scenes that a host may ask for, but a test has no time for."""
    for part in scene._parts:
        try:
            sides = [float(part.values.get(key, 0)) / scene.config.spacing for key in ("width", "height")]
        except (TypeError, ValueError, OverflowError, ZeroDivisionError):
            continue  # refused later
        if 400 < abs(sides[0] * sides[1]) < 1e13:
            return True
    return False


def read(text: bytes, path: pathlib.Path) -> str:
    path.write_bytes(text)
    try:
        scene = granperi.Scene.read(path)
        if too_large(scene):
            return "large"
        scene.config = scene.config.replace(threads=1)
        scene.probe_files("result.h5")
        with scene.build() as sim:
            scene.add_probes(sim)
            sim.step(1)
            if not (sim.state.time >= 0):
                raise AssertionError(sim.state)
        if granperi.Scene.parse(scene.text(str(path.parent)), str(path)).text(str(path.parent)) != scene.text(str(path.parent)):
            raise AssertionError("a scene that is written is another one")
        return "run"
    except granperi.Error as error:
        if not str(error):
            raise
        return type(error).__name__


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("corpus", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    texts = [file.read_bytes() for file in sorted(options.corpus.iterdir())]
    found: dict[str, int] = {}
    reached: set[tuple[str, int]] = set()

    def trace(frame, event, _):
        if frame.f_code.co_filename not in (_scene.__file__, _scene_tables.__file__):
            return None
        reached.add((frame.f_code.co_filename, frame.f_lineno))
        return trace

    import tempfile

    warnings.simplefilter("ignore", granperi.GranperiWarning)
    with tempfile.TemporaryDirectory() as directory:
        path = pathlib.Path(directory) / "scene.toml"
        for text in texts:
            read(text, path)
        rng = random.Random(options.seed)
        pool = list(texts)
        count = 0
        end = time.monotonic() + options.seconds
        while time.monotonic() < end:
            text = mutate(rng.choice(rng.choice((pool, texts))), rng.choice(texts), rng)
            before = len(reached)
            sys.settrace(trace)
            try:
                outcome = read(text, path)
            except Exception:
                sys.settrace(None)
                print(f"input {count}:\n{text!r}", file=sys.stderr)
                raise
            finally:
                sys.settrace(None)
            if len(reached) > before and len(pool) < 2000:  # coverage-guided: what reaches new lines is changed further
                pool.append(text)
            found[outcome] = found.get(outcome, 0) + 1
            count += 1
    print(f"{count} scene files, {len(reached)} lines of _scene*.py reached: "
          + ", ".join(f"{n} {name}" for name, n in sorted(found.items())))


if __name__ == "__main__":
    main()
