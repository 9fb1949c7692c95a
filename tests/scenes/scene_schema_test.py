#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""docs/scene.schema.json against the scenes and against what the program itself accepts.

Usage: scene_schema_test.py APSL_PROGRAM PROJECT_FOLDER
"""
import copy
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import jsonschema

program, project = Path(sys.argv[1]), Path(sys.argv[2])
schema = json.loads((project / "docs/scene.schema.json").read_text())
validator = jsonschema.Draft7Validator(schema)

# Every object that a scene can hold, once; values are its own defaults or harmless.
FULL = {
    "mesh": {"grid": {"vertices": [5, 5], "size": [1, 1], "diagonals": "uniform", "jitter": 0.1, "plane": "vertical"}},
    "density": 0.2,
    "pins": [
        {"vertices": [0], "motion": {"rotate": {"axis": [0, 1, 0], "degrees_per_second": 9, "center": [0, 0, 0]},
                                     "start": 0, "stop": 1}},
        {"corners": ["min_x_max_y"], "motion": {"translate": {"velocity": [0, 0, 1]}}},
        {"box": {"min": [-1, -1, -1], "max": [1, 1, 1]}},
    ],
    "masses": [{"vertices": [1], "factor": 10}, {"corners": ["max_x_max_y"], "factor": 2},
               {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}, "factor": 0.1}],
    "start": {"scale": [1, 0, -1], "random": 0.1, "rest_areas": 1.5},
    "gravity": [0, -9.81, 0], "time_step": 0.01, "steps_per_frame": 2, "frames": 3,
    "integrator": {"implicit_springs": {"stretch_stiffness": 1, "bend_stiffness": 1, "damping": 1}},
    "strain_limiting": {"matrix": "consistent", "apply": "matrix_free", "execution": "one_group",
                        "regularization": 1.2, "sub_steps": 10, "target_area_change": 0, "tolerance": 0.1,
                        "max_iterations": 50, "adaptive_threshold": 8, "first_regularization": 1.01,
                        "warm_start_sub_steps": 10, "solver": "conjugate_gradient", "bound_interval": 2,
                        "stretch_ceiling": 0},
    "colliders": [
        {"sphere": {"center": [0, 0, 0], "radius": 1, "friction": 0.1, "thickness": 0.1}},
        {"plane": {"point": [0, 0, 0], "normal": [0, 1, 0], "friction": 0.1, "thickness": 0.1},
         "motion": {"rotate": {"axis": [0, 1, 0], "degrees_per_second": 1, "center": [0, 0, 0]}, "start": 1, "stop": 2}},
        {"capsule": {"a": [0, 0, 0], "b": [0, 1, 0], "radius": 1, "friction": 0.1, "thickness": 0.1}},
    ],
}
TUBE = {"mesh": {"tube": {"radius": [1, 1], "height": 1, "segments": [8, 4], "diagonals": "random", "jitter": 0.1}},
        "integrator": {"bending_springs": {"bend_stiffness": 1, "damping": 1}}}
STAND_ALONE = {"mesh": {"grid": {}}, "integrator": {"stand_alone": {"damping": 1}}, "strain_limiting": {}}
NONE = {"mesh": {"grid": {}}, "integrator": {"none": {}}}
FILE = {"mesh": {"file": "mesh.obj", "height": 1, "weld": 0.001}}

# What neither may accept, as changes of FULL: where, and the value there.
BAD_VALUES = [
    (("mesh",), {}), (("mesh",), {"grid": {}, "file": "x.obj"}), (("mesh",), {"grid": {}, "height": 1}),
    (("mesh", "grid", "vertices"), [1, 5]), (("mesh", "grid", "vertices"), [5]), (("mesh", "grid", "size"), [0, 1]),
    (("mesh", "grid", "diagonals"), "zigzag"), (("mesh", "grid", "jitter"), 1), (("mesh", "grid", "plane"), 3),
    (("density",), -1), (("density",), "heavy"), (("density",), None), (("gravity",), [0, 1]), (("time_step",), 0),
    (("frames",), 0), (("frames",), 1.5), (("steps_per_frame",), 0), (("pins",), {}), (("pins", 0, "vertices"), [-1]),
    (("pins", 0, "vertices"), []), (("pins", 1, "corners"), []), (("masses", 0, "vertices"), []),
    (("mesh",), {"grid": {}, "weld": 1}), (("mesh",), {"file": "x.obj", "weld": -1}), (("mesh",), {"file": ""}),
    (("strain_limiting", "regularization"), []), (("strain_limiting", "stretch_ceiling"), 1),
    (("strain_limiting", "stretch_ceiling"), [0, 1]), (("strain_limiting", "stretch_ceiling"), []),
    (("pins", 1, "corners"), ["min_w"]), (("pins", 2), {}), (("pins", 0, "motion"), {}),
    (("pins", 0, "motion", "start"), -1), (("integrator",), {}), (("integrator",), {"none": {}, "stand_alone": {}}),
    (("integrator",), {"stand_alone": {"bend_stiffness": 1}}), (("integrator",), {"stand_alone": {"tethers": 1e-3}}), (("integrator",), {"stand_alone": {"damping": -1}}),
    (("integrator", "implicit_springs", "damping"), -1), (("strain_limiting", "regularization"), 0.9),
    (("strain_limiting", "regularization"), [1, 0.9]), (("strain_limiting", "tolerance"), 1),
    (("strain_limiting", "matrix"), "exact"), (("strain_limiting", "sub_steps"), -1),
    (("strain_limiting", "max_iterations"), 0), (("strain_limiting", "max_iterations"), 10001), (("strain_limiting", "adaptive_threshold"), -1),
    (("strain_limiting", "first_regularization"), 0.5), (("strain_limiting", "warm_start_sub_steps"), -1),
    (("strain_limiting", "execution"), "serial"), (("strain_limiting", "solver"), "jacobi"), (("strain_limiting", "bound_interval"), 0), (("strain_limiting", "target_area_change"), -1),
    (("masses",), {}), (("masses", 0), {"factor": 2}), (("masses", 0, "factor"), 0), (("masses", 1, "corners"), ["x"]),
    (("start",), []), (("start", "scale"), [1, 1]), (("start", "random"), -1), (("start", "rest_areas"), 0),
    (("colliders", 0), {}), (("colliders", 1), {"motion": {"translate": {}}}), (("colliders", 1, "motion"), {}),
    (("colliders", 0), {"sphere": {}, "plane": {}}), (("colliders", 0, "sphere", "radius"), 0), (("colliders", 1, "plane", "friction"), -1),
]


def objects(value, path=()):
    """The paths of all objects in a document."""
    if isinstance(value, dict):
        yield path
        for key, entry in value.items():
            yield from objects(entry, path + (key,))
    elif isinstance(value, list):
        for index, entry in enumerate(value):
            yield from objects(entry, path + (index,))


def at(value, path):
    for key in path:
        value = value[key]
    return value


def changed(document, path, value):
    document = copy.deepcopy(document)
    at(document, path[:-1])[path[-1]] = value
    return document


def known_to_schema(document, path):
    """The keys that the schema allows in the object at `path`, which holds one that it does not."""
    for error in validator.iter_errors(document):
        if error.validator == "additionalProperties" and tuple(error.absolute_path) == path:
            return set(error.schema["properties"])
    return None


class SceneSchema(unittest.TestCase):
    def run_validate(self, document):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.json"
            file.write_text(json.dumps(document))
            (Path(folder) / "mesh.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
            return subprocess.run([program, "validate", file], capture_output=True, text=True)

    def test_schema_is_one(self):
        jsonschema.Draft7Validator.check_schema(schema)

    def test_every_scene_of_the_project(self):
        scenes = sorted((project / "scenes").glob("*.json"))
        self.assertGreaterEqual(len(scenes), 6)
        for scene in scenes:
            with self.subTest(scene=scene.name):
                self.assertEqual([error.message for error in validator.iter_errors(json.loads(scene.read_text()))], [])

    def test_full_documents_are_accepted_by_both(self):
        for document in (FULL, TUBE, STAND_ALONE, NONE, FILE):
            self.assertEqual([error.message for error in validator.iter_errors(document)], [])
            run = self.run_validate(document)
            self.assertEqual(run.returncode, 0, run.stderr)

    def test_bad_values_are_refused_by_both(self):
        for path, value in BAD_VALUES:
            with self.subTest(path=path, value=value):
                document = changed(FULL, path, value)
                self.assertFalse(validator.is_valid(document))
                run = self.run_validate(document)
                self.assertEqual(run.returncode, 2)
                self.assertEqual(run.stderr.count("\n"), 1)

    def test_both_know_the_same_keys_in_every_object(self):
        seen = set()
        for document in (FULL, TUBE, STAND_ALONE, NONE, FILE):
            for path in objects(document):
                with self.subTest(path=path):
                    extended = changed(document, path + ("zebra",), 1)
                    run = self.run_validate(extended)
                    self.assertEqual(run.returncode, 2)
                    match = re.search(r"zebra: unknown key, expected (no key|(?:one of )?(?P<keys>.*))$",
                                      run.stderr.strip())
                    self.assertIsNotNone(match, run.stderr)
                    known_to_program = set((match["keys"] or "").split(", ")) - {""}
                    self.assertEqual(known_to_program, known_to_schema(extended, path))
                    seen |= {(path, key) for key in known_to_program}
        # Every key of an object in these is one that both know, so no key is left untried.
        self.assertGreater(len(seen), 60)

    def test_defaults_in_the_schema_are_legal(self):
        def walk(node):
            if isinstance(node, dict):
                if "default" in node and "$ref" not in node:
                    rest = {key: value for key, value in node.items() if key != "default"}
                    rest["definitions"] = schema["definitions"]
                    self.assertTrue(jsonschema.Draft7Validator(rest).is_valid(node["default"]), node)
                for entry in node.values():
                    walk(entry)
            elif isinstance(node, list):
                for entry in node:
                    walk(entry)
        walk({key: value for key, value in schema.items() if key != "definitions"})
        walk({f"definition {key}": value for key, value in schema["definitions"].items()})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
