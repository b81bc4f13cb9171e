"""A stand-in for preCICE: the calls that two participants in two threads make, for one serial implicit coupling.

It reads the same configuration and does what it says: windows and iterations, saved states, mapping by nearest
projection, acceleration by least squares. It is no copy of preCICE and shows nothing of how fast that is.
"""

import queue
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from cograin import Mapping, QuasiNewton


class Config:
    """What a configuration says, of the parts that are supported."""

    def __init__(self, path):
        # The prefixes of the tags are declared nowhere.
        tree = ElementTree.fromstring(re.sub(r"<(/?)([\w-]+):", r"<\1\2_", Path(path).read_text()).encode())
        scheme = tree.find("coupling-scheme_serial-implicit")
        self.first, self.second = (scheme.find("participants").get(key) for key in ("first", "second"))
        self.window = float(scheme.find("time-window-size").get("value"))
        self.end = float(scheme.find("max-time").get("value"))
        self.limit = float(scheme.find("relative-convergence-measure").get("limit"))
        self.most = int(scheme.find("max-iterations").get("value"))
        self.relaxation = float(scheme.find("acceleration_IQN-ILS/initial-relaxation").get("value"))
        self.reused = int(scheme.find("acceleration_IQN-ILS/time-windows-reused").get("value"))
        self.sent = {each.get("from"): (each.get("mesh"), each.get("data")) for each in scheme.findall("exchange")}
        assert scheme.find(f"exchange[@from='{self.second}']").get("initialize") == "yes"
        parts = tree.findall("participant")
        self.mappings = {
            part.get("name"): {
                each.get("direction"): (each.get("from"), each.get("to"), each.get("constraint"))
                for each in part
                if each.tag == "mapping_nearest-projection"
            }
            for part in parts
        }
        self.received = {
            part.get("name"): [each.get("name") for each in part.findall("receive-mesh")] for part in parts
        }


class Nearest:
    """The mapping onto a mesh without triangles: to the nearest vertex."""

    def __init__(self, nodes, points):
        self.matrix = np.zeros((len(points), len(nodes)))
        apart = np.linalg.norm(points[:, None] - nodes[None], axis=2)
        self.matrix[np.arange(len(points)), apart.argmin(axis=1)] = 1.0

    def displacement(self, values):
        return self.matrix @ values

    def force(self, values):
        return self.matrix.T @ values


class Line:
    """The line between two participants."""

    def __init__(self):
        self.ways = {}

    def way(self, name):
        """What goes to this participant."""
        return self.ways.setdefault(name, queue.Queue())


class Participant:
    """One of the two; `line` joins them, and `log` counts what was called."""

    def __init__(self, name, config, line):
        self.name, self.config, self.line = name, Config(config), line
        self.is_first = name == self.config.first
        self.other = self.config.second if self.is_first else self.config.first
        self.meshes, self.triangles, self.given, self.written = {}, {}, None, None
        self.time, self.inside, self.iterations = 0.0, 0.0, []
        self.writing, self.reading, self.ongoing, self.complete = True, False, True, False
        self.trials, self.past = [], []

    # Meshes

    def get_mesh_dimensions(self, mesh):
        return 3

    def set_mesh_vertices(self, mesh, places):
        self.meshes[mesh] = np.array(places, dtype=float).reshape(-1, 3)
        return np.arange(len(self.meshes[mesh]), dtype=np.int32)

    def requires_mesh_connectivity_for(self, mesh):
        return True

    def set_mesh_triangles(self, mesh, triangles):
        self.triangles[mesh] = np.array(triangles)

    # Time

    def requires_initial_data(self):
        return not self.is_first

    def initialize(self):
        received = self.config.received[self.name]
        if not received:
            mine = next(iter(self.meshes))
            self.send((mine, self.meshes[mine], self.triangles.get(mine)))
        for _ in received:
            mesh, places, triangles = self.take()
            self.meshes[mesh], self.triangles[mesh] = places, triangles
        if self.is_first:
            self.given = self.take()
        else:
            self.trials = [(self.outward(self.written), None)]
            self.send(self.outward(self.written))
            self.given = self.take()
            self.begun = self.trials[0][0]

    def is_coupling_ongoing(self):
        return self.ongoing

    def is_time_window_complete(self):
        return self.complete

    def get_max_time_step_size(self):
        return self.config.window - self.inside

    def requires_writing_checkpoint(self):
        asked, self.writing = self.writing, False
        return asked

    def requires_reading_checkpoint(self):
        asked, self.reading = self.reading, False
        return asked

    def advance(self, length):
        self.inside += length
        self.complete = False
        if self.inside < self.config.window * (1.0 - 1e-9):
            return
        self.inside = 0.0
        if self.is_first:
            self.send(self.outward(self.written))
            self.given, converged = self.take()
        else:
            converged, following = self.accelerated(self.outward(self.written))
            self.send((following, converged))
        self.complete, self.reading, self.writing = converged, not converged, converged
        if converged:
            self.time += self.config.window
            self.ongoing = self.time < self.config.end * (1.0 - 1e-9)
        if not self.is_first and self.ongoing:
            self.given = self.take()

    def finalize(self):
        assert not self.ongoing

    def accelerated(self, found):
        """Whether the forces agree, and those to begin the next iteration with: by least squares over differences."""
        given = self.begun
        residual = found - given
        self.trials.append((residual, found))
        self.trials = [trial for trial in self.trials if trial[1] is not None]
        converged = np.linalg.norm(residual) <= self.config.limit * np.linalg.norm(found)
        assert converged or len(self.trials) < self.config.most, "not converged"
        pairs = [(residual - one, found - other) for one, other in reversed(self.trials[:-1])]
        columns = [*pairs, *(pair for window in self.past for pair in window)]
        columns = [pair for pair in columns if pair[0].any()]
        if converged:
            self.iterations.append(len(self.trials))
            self.past, self.trials = [pairs, *self.past][: self.config.reused], []
            self.begun = found
        elif columns:
            # The newest of those that are independent, as a filter of preCICE leaves them.
            flat = [(one.ravel(), other.ravel()) for one, other in columns]
            residuals, answers = QuasiNewton._independent(flat)
            weights = np.linalg.lstsq(residuals, -residual.ravel(), rcond=None)[0]
            self.begun = found + (answers @ weights).reshape(found.shape)
        else:
            self.begun = given + self.config.relaxation * residual
        return converged, self.begun

    # Data

    def write_data(self, mesh, data, vertices, values):
        assert data == self.config.sent[self.name][1] and np.shape(values) in (
            self.meshes[mesh].shape,
            (len(self.meshes[mesh]),),
        )
        self.written = np.array(values, dtype=float)

    def read_data(self, mesh, data, vertices, time):
        assert data == self.config.sent[self.other][1]
        mapping = self.config.mappings[self.name].get("read")
        if mapping is None:
            return self.given.copy()
        there, here, constraint = mapping
        assert here == mesh and constraint == "consistent"
        return self.between(there, here).displacement(self.given)

    def outward(self, values):
        """What was written, on the mesh on which it is sent."""
        mapping = self.config.mappings[self.name].get("write")
        if mapping is None:
            return values
        here, there, constraint = mapping
        assert constraint == "conservative"
        return self.between(there, here).force(values)

    def between(self, there, here):
        if self.triangles.get(there) is None:
            return Nearest(self.meshes[there], self.meshes[here])
        return Mapping(self.meshes[there], self.triangles[there], self.meshes[here])

    def send(self, what):
        self.line.way(self.other).put(what)

    def take(self):
        return self.line.way(self.name).get(timeout=300.0)
