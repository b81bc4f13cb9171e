//! What more threads than this machine has cores would bring: the pieces of time steps, measured on one thread and scheduled on many.
//!
//! `cargo bench --bench schedule -- [SCENE.toml | SPHERES] [--steps N] [--from T] [--repeats N] [--cut N] [--write FILE.csv]`
//!
//! Steps (50) after the time T (0.02 s) are made again and again from the same state: with one thread, with two, and with one that tells of each
//! piece of each loop. The least time of each counts. Pieces then go to threads as the program hands them out (`src/base/threads`), where each
//! change of a line of the cache from one core to another takes as long as it does between two threads here. Between the loops one thread works.
//! Not in the model: caches and memory that threads share. `--cut` divides each slab into so many columns that wait for their neighbours as
//! slabs do. `--write` writes the pieces: step, stage, loop, piece, slabs or not, seconds. Columns: time of a step, times as fast as one
//! thread. The last is for as many processes of one thread, each with slabs of its own and two messages to each neighbour in a step.

use cograin::scene::{Scene, Source};
use cograin::simulation::{LoopEvent, Simulation};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Instant;

/// Large arrays begin at different places of a page, as in the program.
#[global_allocator]
static ALLOCATOR: cograin::memory::Staggered = cograin::memory::Staggered;

/// Numbers of threads.
const THREADS: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];

/// Time of a message between two processes of one machine \[s\], and bytes that it brings in a second.
const MESSAGE: (f64, f64) = (1e-6, 5e9);

/// Bytes of a particle that a neighbour needs: place, velocity, angular velocity, and back force and torque.
const HALO: f64 = 160.0;

/// What was told, and when.
static TOLD: Mutex<Vec<(Instant, Told)>> = Mutex::new(Vec::new());

/// What is told while time steps are made.
#[derive(Clone, Copy, PartialEq)]
enum Told {
    /// A stage is done.
    Stage(&'static str),
    /// Something happened in a loop.
    Loop(LoopEvent),
}

/// Notes what is told.
fn tell(told: Told) {
    TOLD.lock().expect("one thread tells").push((Instant::now(), told));
}

/// Part of a time step.
#[derive(Clone)]
struct Part {
    /// The stage that it belongs to.
    stage: &'static str,
    /// Time of each piece \[s\]; of a single one, which one thread does.
    pieces: Vec<f64>,
    /// Whether pieces of odd number wait for their neighbours.
    in_slabs: bool,
}

/// Parts of the time steps that were told, in their order. `cost` is what telling takes \[s\].
fn parts(told: &[(Instant, Told)], begun: Instant, cost: f64) -> Vec<Part> {
    let (mut parts, mut last, mut first) = (Vec::<Part>::new(), begun, 0);
    let alone = |time| Part { stage: "", pieces: vec![time], in_slabs: false };
    for &(now, event) in told {
        let time = (now.duration_since(last).as_secs_f64() - cost).max(0.0);
        last = now;
        match event {
            Told::Loop(LoopEvent::Begin { pieces, in_slabs }) => {
                parts.push(alone(time));
                parts.push(Part { stage: "", pieces: vec![0.0; pieces], in_slabs });
            }
            Told::Loop(LoopEvent::Done(piece)) => parts.last_mut().expect("it has begun").pieces[piece] = time,
            Told::Loop(LoopEvent::End) => parts.push(alone(time)),
            Told::Stage(name) => {
                parts.push(alone(time));
                parts[first..].iter_mut().for_each(|part| part.stage = name);
                first = parts.len();
            }
        }
    }
    parts[first..].iter_mut().for_each(|part| part.stage = "between time steps");
    parts
}

/// A piece that waits for no other.
struct Ready {
    /// Which.
    piece: usize,
    /// The thread that may take it from its own share.
    owner: usize,
    /// Since when \[s\].
    from: f64,
}

/// What is to be done in a loop, and what waits for what.
struct Graph {
    /// Time of each piece \[s\].
    times: Vec<f64>,
    /// Pieces that wait for each.
    next: Vec<Vec<usize>>,
    /// How many pieces each waits for.
    awaits: Vec<usize>,
}

impl Graph {
    /// Of a loop whose slabs are cut into so many columns: odd slabs wait for their neighbours, odd columns for those beside them, as odd slabs
    /// do for slabs.
    fn of(part: &Part, cut: usize) -> Self {
        let (slabs, columns) = (part.pieces.len(), if part.in_slabs { cut } else { 1 });
        let count = slabs * columns;
        let times = (0..count).map(|piece| part.pieces[piece / columns] / columns as f64).collect();
        let mut graph = Self { times, next: vec![Vec::new(); count], awaits: vec![0; count] };
        if !part.in_slabs {
            return graph;
        }
        // Pieces of four kinds, by the parity of slab and column, one kind after the other where they touch.
        let kind = |piece: usize| 2 * (piece / columns % 2) + piece % columns % 2;
        for piece in 0..count {
            let (slab, column) = (piece / columns, piece % columns);
            for other in (slab.saturating_sub(1)..(slab + 2).min(slabs))
                .flat_map(|slab| {
                    (column.saturating_sub(1)..(column + 2).min(columns)).map(move |it| slab * columns + it)
                })
                .filter(|&other| kind(other) < kind(piece))
            {
                graph.next[other].push(piece);
                graph.awaits[piece] += 1;
            }
        }
        graph
    }

    /// When so many threads have done it, if a line of the cache changes cores in `hop` \[s\].
    fn schedule(mut self, threads: usize, hop: f64) -> f64 {
        let count = self.times.len();
        if threads == 1 || count < 2 {
            return self.times.iter().sum();
        }
        let free: Vec<usize> = (0..count).filter(|&piece| self.awaits[piece] == 0).collect();
        let owner = |place: usize| (0..threads).find(|it| place < free.len() * (it + 1) / threads).unwrap_or(0);
        let mut ready: Vec<Ready> =
            free.iter().enumerate().map(|(place, &piece)| Ready { piece, owner: owner(place), from: 0.0 }).collect();
        // Who did the last piece that each one waits for, and when.
        let mut last = vec![(0.0, 0); count];
        // Helpers see the open gate, and go through it one after the other.
        let mut now: Vec<f64> = (0..threads).map(|it| if it == 0 { 0.0 } else { (it + 1) as f64 * hop }).collect();
        for _ in 0..count {
            // What can begin first; of several the one that became ready last, as the program does.
            let begin = |thread: usize, it: &Ready| {
                (now[thread].max(it.from) + if it.owner == thread { 0.0 } else { 2.0 * hop }, -it.from)
            };
            let pairs = (0..threads).flat_map(|thread| (0..ready.len()).map(move |at| (thread, at)));
            let order = |&(a, i): &(usize, usize), &(b, j): &(usize, usize)| {
                begin(a, &ready[i]).partial_cmp(&begin(b, &ready[j])).expect("times are numbers")
            };
            let (thread, at) = pairs.min_by(order).expect("a piece is ready");
            let start = begin(thread, &ready[at]).0;
            let piece = ready.remove(at).piece;
            now[thread] = start + self.times[piece];
            for other in std::mem::take(&mut self.next[piece]) {
                self.awaits[other] -= 1;
                last[other] = if now[thread] > last[other].0 { (now[thread], thread) } else { last[other] };
                if self.awaits[other] == 0 {
                    ready.push(Ready { piece: other, owner: last[other].1, from: last[other].0 });
                }
            }
        }
        // Helpers leave through the gate one after the other.
        now.sort_by(f64::total_cmp);
        now.into_iter().fold(0.0, |gate: f64, end| gate.max(end) + hop)
    }
}

/// What the arguments say.
struct Options {
    /// A scene file, or how many spheres lie in a box.
    scene: String,
    /// Time steps.
    steps: usize,
    /// When they begin \[s\].
    from: f64,
    /// How often they are made.
    repeats: usize,
    /// Columns of a slab.
    cut: usize,
    /// Where pieces are written.
    write: Option<String>,
}

impl Options {
    /// Reads the arguments.
    fn read() -> Self {
        let mut it = Self { scene: "20000".into(), steps: 50, from: 0.02, repeats: 10, cut: 1, write: None };
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().expect("a value follows");
            let number = |text: String| text.parse().expect("a number");
            match argument.as_str() {
                "--bench" => {}
                "--steps" => it.steps = number(value()),
                "--from" => it.from = value().parse().expect("a time"),
                "--repeats" => it.repeats = number(value()),
                "--cut" => it.cut = number(value()),
                "--write" => it.write = Some(value()),
                scene => it.scene = scene.into(),
            }
        }
        it
    }

    /// The scene, with so many threads.
    fn start(&self, threads: usize) -> Simulation {
        let text = match self.scene.parse::<f64>() {
            Ok(spheres) => bed(spheres),
            Err(_) => std::fs::read_to_string(&self.scene).expect("the scene can be read"),
        };
        let mut text: String = text
            .lines()
            .filter(|line| !line.starts_with("threads"))
            .fold(String::new(), |text, line| text + line + "\n");
        text = text.replace("[run]\n", &format!("[run]\nthreads = {threads}\n"));
        let source = Source { name: "scene".into(), text, files: BTreeMap::new() };
        let scene = Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"));
        Simulation::new(Arc::new(scene)).expect("the scene starts")
    }
}

/// Spheres of 5 mm that come to rest in a cube.
fn bed(spheres: f64) -> String {
    let (radius, fraction) = (5e-3_f64, 0.6);
    let edge = (spheres * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) / fraction).cbrt();
    let mut text = format!(
        "gravity = [0.0, 0.0, -9.81]\n[run]\nend = 1.0\n[material.grain]\nyoungs_modulus = 5e7\npoissons_ratio = 0.3\ndensity = 2500.0\n\
         [pair.grain.grain]\nrestitution = 0.5\nfriction = 0.5\n[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n\
         [particles.bed]\nmaterial = \"grain\"\n[particles.bed.packing]\nbox = [[0.0, 0.0, 0.0], [{edge}, {edge}, {edge}]]\n\
         solid_fraction = {fraction}\nradius = [{}, {}]\n",
        0.8 * radius,
        1.2 * radius
    );
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        for (side, place, sign) in [("low", 0.0, 1.0), ("high", edge, -1.0)] {
            let [point, normal] = [place, sign].map(|number| [0, 1, 2].map(|it| if it == axis { number } else { 0.0 }));
            let plane = format!("plane = {{ point = {point:?}, normal = {normal:?} }}");
            let _ = writeln!(text, "[boundary.{name}_{side}]\n{plane}\nmaterial = \"grain\"");
        }
    }
    text
}

/// Time that a line of the cache takes from one core to another \[s\]: half of a way there and back.
fn hop() -> f64 {
    const TURNS: usize = 20_000;
    let turn = AtomicUsize::new(0);
    let wait = |value: usize| {
        while turn.load(Ordering::Acquire) != value {
            std::hint::spin_loop();
        }
    };
    let once = || {
        std::thread::scope(|scope| {
            scope.spawn(|| {
                for number in 0..TURNS {
                    wait(2 * number + 1);
                    turn.store(2 * number + 2, Ordering::Release);
                }
            });
            let begun = Instant::now();
            for number in 0..TURNS {
                turn.store(2 * number + 1, Ordering::Release);
                wait(2 * number + 2);
            }
            let time = begun.elapsed().as_secs_f64();
            turn.store(0, Ordering::Release);
            time / (2 * TURNS) as f64
        })
    };
    (0..10).map(|_| once()).fold(f64::INFINITY, f64::min)
}

/// What telling takes \[s\].
fn cost() -> f64 {
    TOLD.lock().expect("nobody tells").clear();
    for _ in 0..10_000 {
        tell(Told::Stage(""));
    }
    let told = std::mem::take(&mut *TOLD.lock().expect("nobody tells any more"));
    let between = told.windows(2).map(|pair| (pair[1].0 - pair[0].0).as_secs_f64());
    between.sum::<f64>() / (told.len() - 1) as f64
}

/// Time of so many processes with slabs of their own \[s\]; none where a process has no slab.
fn processes(parts: &[Part], slabs: &[u32], count: usize) -> Option<f64> {
    let all = *slabs.last()? as f64;
    // Slabs go to processes by their particles.
    let of = |slab: usize| ((slabs[slab] as f64 + slabs[slab + 1] as f64) / 2.0 / all * count as f64) as usize;
    let mut times = vec![0.0; count];
    let mut particles = vec![0.0; count];
    for slab in 0..slabs.len() - 1 {
        particles[of(slab)] += f64::from(slabs[slab + 1] - slabs[slab]) / all;
    }
    for part in parts {
        let sum: f64 = part.pieces.iter().sum();
        if part.in_slabs && part.pieces.len() + 1 == slabs.len() {
            part.pieces.iter().enumerate().for_each(|(slab, time)| times[of(slab)] += time);
        } else {
            let alone = part.pieces.len() < 2;
            times.iter_mut().zip(&particles).for_each(|(time, share)| *time += if alone { sum } else { sum * share });
        }
    }
    let widest = slabs.windows(2).map(|ends| f64::from(ends[1] - ends[0])).fold(0.0, f64::max);
    let messages = if count > 1 { 4.0 * MESSAGE.0 + 2.0 * widest * HALO / MESSAGE.1 } else { 0.0 };
    particles.iter().all(|&share| share > 0.0).then(|| times.into_iter().fold(0.0, f64::max) + messages)
}

#[allow(clippy::print_stdout, reason = "a benchmark prints")]
fn main() {
    let options = Options::read();
    let mut alone = options.start(1);
    alone.advance(options.from).expect("it runs");
    let state = alone.state().clone();
    let interval = options.steps as f64 * state.clock.step;
    let mut told = options.start(1);
    told.watch_loops(|event| tell(Told::Loop(event)));
    told.watch(Box::new(|stage, _| tell(Told::Stage(stage))));
    let mut pair = options.start(2);
    let (hop, cost) = (hop(), cost());
    let mut watched = options.start(2);
    watched.watch(Box::new(|stage, _| tell(Told::Stage(stage))));
    let mut least = [f64::INFINITY; 2];
    let [mut best, mut best_of_two] = [const { Vec::<Part>::new() }; 2];
    let mut slabs = Vec::new();
    for _ in 0..options.repeats {
        for (simulation, least) in [&mut alone, &mut pair].into_iter().zip(&mut least) {
            simulation.return_to(&state);
            let begun = Instant::now();
            simulation.advance(interval).expect("it runs");
            *least = begun.elapsed().as_secs_f64().min(*least);
        }
        for (simulation, best) in [(&mut told, &mut best), (&mut watched, &mut best_of_two)] {
            simulation.return_to(&state);
            TOLD.lock().expect("nobody tells").clear();
            let begun = Instant::now();
            simulation.advance(interval).expect("it runs");
            let found = parts(&TOLD.lock().expect("nobody tells any more"), begun, cost);
            if best.is_empty() || whole(&found) < whole(best) {
                *best = found;
            }
        }
        slabs.clone_from(&told.state().neighbours.slabs);
    }
    let steps = (told.state().clock.steps - state.clock.steps) as f64;
    let micro = |seconds: f64| 1e6 * seconds / steps;
    let at = |threads: usize| best.iter().map(|part| Graph::of(part, options.cut).schedule(threads, hop)).sum::<f64>();
    println!(
        "{} particles, {steps} time steps with {} lists, {} slabs; a line of the cache changes cores in {:.0} ns",
        told.state().particles.len(),
        told.state().clock.rebuilds - state.clock.rebuilds,
        slabs.len() - 1,
        1e9 * hop
    );
    println!(
        "measured: one thread {:.1} us, two {:.1} us, {:.2} times as fast",
        micro(least[0]),
        micro(least[1]),
        least[0] / least[1]
    );
    println!("threads    us a step   times as fast   processes");
    for threads in THREADS {
        let process = processes(&best, &slabs, threads).map_or_else(String::new, |time| format!("{:.1}", at(1) / time));
        println!("{threads:7} {:12.1} {:15.2} {process:>11}", micro(at(threads)), at(1) / at(threads));
    }
    stages([&best, &best_of_two], &options, (hop, steps));
    if let Some(file) = &options.write {
        std::fs::write(file, table(&best)).expect("the file can be written");
    }
}

/// Time of all parts one after the other \[s\].
fn whole(parts: &[Part]) -> f64 {
    parts.iter().flat_map(|part| &part.pieces).sum()
}

/// Prints what each stage takes with some numbers of threads, the longest first; with two also as measured.
#[allow(clippy::print_stdout, reason = "a benchmark prints")]
fn stages([parts, of_two]: [&[Part]; 2], options: &Options, (hop, steps): (f64, f64)) {
    let mut stages: BTreeMap<&str, [f64; 6]> = BTreeMap::new();
    for part in parts {
        let sums = stages.entry(part.stage).or_default();
        if part.pieces.len() < 2 {
            sums[0] += part.pieces.iter().sum::<f64>();
        }
        for (sum, threads) in sums[1..5].iter_mut().zip([1, 2, 16, 64]) {
            *sum += Graph::of(part, options.cut).schedule(threads, hop);
        }
    }
    for part in of_two {
        stages.entry(part.stage).or_default()[5] += part.pieces.iter().sum::<f64>();
    }
    let mut stages: Vec<_> = stages.into_iter().collect();
    stages.sort_by(|a, b| b.1[3].total_cmp(&a.1[3]));
    println!("{:28} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}", "us a step", "serial", "1", "2", "16", "64", "2 measured");
    for (name, sums) in stages {
        let columns = sums.map(|sum| format!("{:9.2}", 1e6 * sum / steps)).join(" ");
        println!("{name:28} {columns}");
    }
}

/// The pieces as a table.
fn table(parts: &[Part]) -> String {
    let mut text = String::from("part,stage,piece,in_slabs,seconds\n");
    for (number, part) in parts.iter().enumerate() {
        for (piece, time) in part.pieces.iter().enumerate() {
            let _ = writeln!(text, "{number},{},{piece},{},{time:e}", part.stage, part.in_slabs);
        }
    }
    text
}
