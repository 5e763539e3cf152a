// Verification and measurement, as mssim bench does both, and the file of results.
'use strict';

// Statistics (src/statistics/statistics.h). mssim computes the same numbers again when it reads a result.

const ascending = values => [...values].sort((a, b) => a - b);
const median = values => {
  const sorted = ascending(values), half = sorted.length >> 1;
  return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
};
/** The median, and the distribution-free 95 % interval for it; of fewer than six samples the least and the largest. */
function medianInterval(samples) {
  const sorted = ascending(samples), n = sorted.length;
  let rank = 0;
  for (let term = 2 ** -n, tail = term; 1 - 2 * tail >= 0.95; tail += term *= (n - rank + 1) / rank) ++rank;
  rank = Math.max(rank, 1);
  return {median: median(sorted), low: sorted[rank - 1], high: sorted[n - rank]};
}
const isWarm = trials =>
  trials.length >= 3 && Math.min(...trials.slice(-2)) >= 0.98 * Math.min(...trials.slice(0, -2));
const shuffled = list => {
  const result = [...list];
  for (let i = result.length - 1; i > 0; --i) {
    const j = Math.floor(Math.random() * (i + 1));
    [result[i], result[j]] = [result[j], result[i]];
  }
  return result;
};

/** The smallest step of the browser's clock, s. Browsers make it coarse on purpose. */
function clockGranularity() {
  let smallest = Infinity;
  for (let i = 0; i < 100; ++i) {
    const before = performance.now();
    let after = before;
    while (after === before) after = performance.now();
    smallest = Math.min(smallest, after - before);
  }
  return smallest / 1000;
}

// Verification (src/bench/verification/verification.h).

const isFinite32 = values => values.every(value => Math.abs(value) <= 3.4028234663852886e38);
const areFinite = state => isFinite32(state.position) && isFinite32(state.velocity);

function largestDistance(a, b) {
  let largest = 0;
  for (let i = 0; i < a.length; i += 3)
    largest = Math.max(largest, (a[i] - b[i]) ** 2 + (a[i + 1] - b[i + 1]) ** 2 + (a[i + 2] - b[i + 2]) ** 2);
  return Math.sqrt(largest);
}

let laws;
function energyOf(system, {position, velocity}) {
  laws = laws || new Function(lawsInJavascript() + 'return {spring_energy};')();
  let moving = 0, height = 0;
  for (let node = 0; node < system.nodes; ++node) {
    const [u, v, w] = velocity.subarray(3 * node, 3 * node + 3);
    moving += system.mass[node] / 2 * (u * u + v * v + w * w);
    height += system.mass[node] * system.gravity * (position[3 * node + 1] - system.floor[0]);
  }
  for (let s = 0; s < system.first.length; ++s) {
    const i = 3 * system.first[s], j = 3 * system.second[s];
    const length = Math.hypot(position[j] - position[i], position[j + 1] - position[i + 1], position[j + 2] - position[i + 2]);
    moving += laws.spring_energy(length, system.restLengths[s], system.materials[system.kind[s]]);
  }
  return {moving, total: moving + height};
}

/** Runs the double-precision reference in this page; `pause` lets the browser breathe, and throws if the user stops. */
async function runReference(system, integrator, check, dt, pause) {
  const reference = new ListBackend(system, integrator, dt, Float64Array), most = Math.min(check.steps, data.verification_steps);
  await reference.setState(system.start);
  let state = system.start, steps = 0;
  while (steps < most) {
    const next = Math.min(steps + data.steps_between_looks, most);
    for (let step = steps; step < next; ++step) {
      await reference.step(1);
      await pause();
    }
    const after = await reference.state();
    if (!areFinite(after)) return {failure: 'the double-precision reference blew up'};
    if (after.position.some((y, i) => i % 3 === 1 && !(y > system.floor[0]))) break;
    state = after;
    steps = next;
  }
  if (steps === 0) return {failure: 'a node touches the floor at once'};
  return {steps, state, energy: energyOf(system, state), tolerance: check.tolerance_of_a_step * Math.sqrt(steps)};
}

/** Compares a backend with the reference: sets the row's errors, and returns why it is wrong, if it is. */
async function verify(backend, system, reference, row, pause) {
  if (reference.failure) return reference.failure;
  await backend.setState(system.start);
  const atOnce = backend.device || backend.workers?.length ? data.steps_between_looks : 1;  // others keep the page from drawing
  for (let step = 0; step < reference.steps; step += atOnce) {
    await backend.step(Math.min(atOnce, reference.steps - step));
    await pause();
  }
  const state = await backend.state();
  if (!areFinite(state)) return `not finite after ${reference.steps} steps`;
  row.position_error = largestDistance(state.position, reference.state.position) / system.mean_rest_length;
  const {total} = energyOf(system, state), inMotion = Math.max(reference.energy.moving, system.rounding_energy_j);
  row.energy_drift = (total - reference.energy.total) / inMotion;
  if (!(row.position_error <= reference.tolerance))
    return `position error ${row.position_error.toPrecision(6)} of a rest length exceeds ${reference.tolerance.toPrecision(6)} ` +
      `after ${reference.steps} steps`;
  if (!(Math.abs(row.energy_drift) <= data.energy_tolerance))
    return `energy is off by ${row.energy_drift.toPrecision(6)} of the energy in motion`;
  return '';
}

/** The second part: a small scene that meets the floor, whose end after some steps mssim has computed. */
async function verifySecond(make, scene, integrator) {
  const {steps, tolerance, floor_height, start, position} = scene.checks[integrator.name].second;
  if (steps === 0) return '';
  const laws = scene.checks.second_system;
  const system = buildSystem(laws, start, [floor_height, ...laws.floor.slice(1)]), backend = await make(system);
  let state;
  try {
    await backend.setState(system.start);
    await backend.step(steps);
    state = await backend.state();
  } finally { backend.destroy(); }
  const error = largestDistance(state.position, unpack(position, Float64Array)) / system.mean_rest_length;
  return error <= tolerance ? ''
    : `position error ${error.toPrecision(6)} of a rest length exceeds ${tolerance.toPrecision(6)} after ${steps} steps of a ` +
      'small scene of its kind that meets the floor';
}

// Measurement.

const missingModule = 'there are no rows wasm and wasm-threads: this mssim was built without clang and wasm-ld';
/** Why there is no row wasm-threads; empty if there is one. */
const missingThreads = threads => !self.crossOriginIsolated
  ? 'there is no row wasm-threads: the page is not isolated from other origins. mssim web --serve isolates it; other hosts do so by https and the ' +
    'headers Cross-Origin-Opener-Policy: same-origin and Cross-Origin-Embedder-Policy: require-corp'
  : threads < 2 ? 'there is no row wasm-threads: it would have one thread' : '';

/** Thrown where the user has pressed Stop. */
class Stopped extends Error {}

/** How often the page was hidden or shown again. */
let hides = 0;
document.addEventListener('visibilitychange', () => ++hides);

/** A run. `options`: {scenes, integrators, rounds, sampleSeconds, threads}, the first two names. `show(session)` is called after each change. */
class Session {
  constructor(options, device, adapterName, show) {
    Object.assign(this, {options, device, adapterName, show, rows: [], notes: [], stopping: false, hidden: false, lost: '', done: 0,
                         scene: options.scenes[0], what: ''});
    this.granularity = clockGranularity();
    this.started = new Date().toISOString().replace(/\.\d+Z$/, 'Z');
    this.notes.push(`the browser's clock has steps of ${Number((1e6 * this.granularity).toPrecision(3))} microseconds`);
    const noThreads = missingThreads(options.threads);
    this.backends = ['javascript', data.wasm && 'wasm', data.wasm && !noThreads && 'wasm-threads', device && 'webgpu'].filter(Boolean);
    if (!device) this.notes.push('there was no WebGPU; only the CPU was measured');
    if (!data.wasm || noThreads) this.notes.push(data.wasm ? noThreads : missingModule);
    device?.lost.then(({reason, message}) => {
      if (this.finished) return;
      this.lost = `the browser lost the GPU (${[reason, message].filter(Boolean).join(': ')})`;
      this.device = null;
      this.notes.push(this.lost);
      this.show(this);
    });
    // For the progress: about how many seconds the parts take on a fast computer.
    this.integrators = data.integrators.filter(({name}) => options.integrators.includes(name));
    this.scenes = data.scenes.filter(({name}) => options.scenes.includes(name));
    this.verifying = (scene, integrator) => 0.2 + 5e-5 * scene.nodes * integrator.stages.length;
    this.round = 2 * this.backends.length * options.sampleSeconds * this.integrators.length;
    this.units = 0;
    for (const scene of this.scenes)
      this.units += this.integrators.reduce((sum, it) => sum + this.verifying(scene, it), options.rounds * this.round);
  }

  /** Lets the browser draw, waits while the page is hidden, and throws Stopped. */
  async pause(now = false) {
    if (this.stopping) throw new Stopped();
    if (!now && performance.now() - (this.breath || 0) < 50 && !document.hidden) return;
    await new Promise(resolve => setTimeout(resolve));
    while (document.hidden && !this.stopping) {
      this.hidden = true;
      await new Promise(resolve => setTimeout(resolve, 200));
    }
    this.breath = performance.now();
    if (this.stopping) throw new Stopped();
  }
  advance(scene, what, by = 0) {
    Object.assign(this, {scene: scene.name, what});
    this.done += by;
    this.show(this);
  }

  async run() {
    this.begin = performance.now();
    try {
      for (const scene of this.scenes) await this.measureScene(scene);
    } catch (error) {
      this.endedEarly = true;
      if (!(error instanceof Stopped)) this.notes.push(`the measurement ended early: ${error.message}`);
      else this.notes.push('the user stopped the measurement');
    }
    if (this.hidden) this.notes.push('the page was hidden for a while; what it measured meanwhile was measured again');
    const compiled = this.rows.flatMap(row => row.compile_s || []);
    if (compiled.length) this.notes.push(`compiling the kernels of a row took ${Math.min(...compiled).toPrecision(3)} to ` +
                                         `${Math.max(...compiled).toPrecision(3)} s, which no time contains`);
    this.finished = true;
    this.show(this);
  }

  rowOf(scene, backend, integrator) {
    const published = (scene.published[integrator.paper_name] || {})[data.configurations[backend]];
    const row = {scene: scene.name, nodes: scene.nodes, springs_unique: scene.springs_unique,
                 springs_published: scene.springs_published || '', backend, device: backend === 'webgpu' ? this.adapterName : 'cpu',
                 threads: backend === 'wasm-threads' ? this.options.threads : 1, integrator: integrator.name, dt_s: scene.dt, rounds: 0, paper_ms: published ?? '', verified: false,
                 status: 'ok', note: scene.note, warm_up_trials: 0, outliers: 0, samples: [], steps: 1};
    this.rows.push(row);
    return row;
  }

  async measureScene(scene) {
    const system = buildSystem(scene), timed = [];
    try {
      for (const integrator of this.integrators) {
        this.advance(scene, `${integrator.name}: the double-precision reference`);
        await this.pause(true);
        const reference = await runReference(system, integrator, scene.checks[integrator.name], scene.dt, () => this.pause());
        for (const name of this.backends) {
          const row = this.rowOf(scene, name, integrator);
          await this.attempt(row, async () => {
            const make = its => name === 'webgpu' ? this.makeWebGpu(its, integrator, scene.dt)
              : name === 'javascript' ? new ListBackend(its, integrator, scene.dt, Float32Array)
              : WasmBackend.make(its, integrator, scene.dt, row.threads);
            const failure = await verifySecond(make, scene, integrator);
            row.backend_ = await make(system);
            if (row.backend_.compileSeconds) row.compile_s = row.backend_.compileSeconds;
            const wrong = failure || await verify(row.backend_, system, reference, row, () => this.pause());
            if (wrong) throw new Error(`failed: ${wrong}`);
            row.verified = true;
            await this.warmUp(row, system);
            timed.push(row);
          });
        }
        this.advance(scene, `${integrator.name}: verified`, this.verifying(scene, integrator));
      }
      for (let round = 1; round <= this.options.rounds; ++round) {
        for (const row of shuffled(timed)) await this.attempt(row, () => this.sample(row, system));
        this.advance(scene, `round ${round} of ${this.options.rounds}`, this.round);
        await this.pause(true);
      }
    } finally {
      for (const row of this.rows) {
        row.backend_?.destroy();
        delete row.backend_;
      }
      this.summarise();
      this.show(this);
    }
  }

  makeWebGpu(system, integrator, dt) {
    if (!this.device) throw new Error(`failed: ${this.lost}`);
    return WebGpuBackend.make(this.device, system, integrator, dt);
  }

  /** Why the row of a GPU cannot go on; empty if it can, and for rows of the CPU. */
  lossOf(row) { return row.backend === 'webgpu' ? this.lost : ''; }

  /** Keeps what a row has if its device is lost or the user stops. */
  async attempt(row, work) {
    if (row.status !== 'ok') return;
    let failure = '';
    try {
      if (!this.lossOf(row)) await work();
    } catch (error) {
      if (error instanceof Stopped) throw error;
      failure = error.message || error.name;
    }
    const loss = this.lossOf(row);
    if (loss && row.samples.length) {
      if (!row.note.includes(loss)) row.note = [row.note, loss].filter(Boolean).join('; ');
    } else if (failure || loss) {
      row.verified = false;
      row.status = /^(failed|unsupported): /.test(failure) ? failure : `failed: ${loss || failure}`;
    }
  }

  /** Times steps from the start, which is set outside of the timed region. */
  async time(row, system, steps) {
    for (;;) {
      if (this.lossOf(row)) throw new Error(this.lossOf(row));
      const already = hides;
      await row.backend_.setState(system.start);
      await row.backend_.step(1);
      await row.backend_.setState(system.start);
      const before = performance.now();
      await row.backend_.step(steps);
      const seconds = Math.max((performance.now() - before) / 1000, 1e-9);
      await this.pause(true);
      // Browsers slow hidden pages down.
      if (hides === already) return seconds;
      this.hidden = true;
    }
  }

  /** Finds the steps of a sample, and waits until the backend is warm (src/bench/job/job.cpp). */
  async warmUp(row, system) {
    const target = Math.max(this.options.sampleSeconds, data.least_clock_steps * this.granularity);
    const stepsFor = seconds => Math.max(1, Math.min(Math.floor(target / seconds), Math.max(
      data.max_sample_steps, Math.ceil(data.least_clock_steps * this.granularity / seconds))));
    let steps = 1;
    for (;;) {
      const seconds = await this.time(row, system, steps) / steps;
      const fit = stepsFor(seconds);
      if (fit <= 2 * steps) {
        steps = fit;
        break;
      }
      steps = Math.min(fit, 10 * steps);
    }
    const trialSteps = Math.max(1, Math.floor(steps / 4)), trials = [];
    while (trials.length < data.most_warm_up_trials && !isWarm(trials)) trials.push(await this.time(row, system, trialSteps));
    row.warm_up_trials = trials.length;
    row.steps = stepsFor(median(trials) / trialSteps);
  }

  async sample(row, system) {
    const seconds = await this.time(row, system, row.steps);
    if (!areFinite(await row.backend_.state())) throw new Error(`failed: not finite after ${row.steps} steps`);
    row.samples.push(1000 * seconds / row.steps);
  }

  /** Computes what follows from the samples of all rows. A row whose verification has not ended says nothing: it is left out. */
  summarise() {
    this.rows = this.rows.filter(row => row.verified || row.status !== 'ok');
    for (const row of this.rows) {
      if (row.status === 'ok' && !row.samples.length) row.status = 'not timed: the measurement ended before';
      row.rounds = row.samples.length;
      if (row.status !== 'ok') continue;
      const {median: middle, low, high} = medianInterval(row.samples);
      Object.assign(row, {ms_per_step: middle, ms_per_step_low: low, ms_per_step_high: high,
                          ms_per_step_min: Math.min(...row.samples)});
      // A device that becomes hot slows down from round to round.
      const third = Math.floor(row.samples.length / 3);
      if (third > 1) row.drift = median(row.samples.slice(-third)) / median(row.samples.slice(0, third));
      const base = this.rows.find(it => it.scene === row.scene && it.integrator === row.integrator && it.backend === 'javascript');
      if (base && base !== row && base.samples.length === row.samples.length)
        row.speedup = median(base.samples.map((ms, i) => ms / row.samples[i]));
    }
  }

  /** Milliseconds that are left, about. */
  left() {
    const share = Math.min(this.done / this.units, 1);
    return share > 0 ? (performance.now() - this.begin) * (1 - share) / share : NaN;
  }

  /** The largest drift of a row with a time. */
  drift() { return Math.max(...this.rows.map(row => row.drift || 0)); }

  // One file that mssim report and compare read (src/web/web.h).
  results(about) {
    const notes = [...this.notes];
    if (this.drift() > 1.05) notes.push(`a row became ${((this.drift() - 1) * 100).toFixed(0)} % slower from the first to the ` +
                                        'last third of its rounds: the device may have become hot');
    const provenance = {...data.provenance, started_utc: this.started, command_line: ['mssim', 'web', ...about.settings],
                        cpu: {...data.provenance.cpu, model: about.device, logical_cpus: about.logicalCpus},
                        operating_system: about.system, kernel: [about.browser, ...about.limits].join('; '), memory_bytes: about.memoryBytes,
                        threads: {...data.provenance.threads, asked_for: Math.max(1, ...this.rows.map(row => row.threads))},
                        opencl_devices: about.adapters, noise: notes};
    const quoted = value => /[",\n\r]/.test(value) ? `"${String(value).replaceAll('"', '""')}"` : String(value);
    const csv = lines => lines.map(line => line.map(quoted).join(',') + '\n').join('');
    const names = ['scene', 'backend', 'integrator'];
    return JSON.stringify({
      mssim_web_results: 1, provenance,
      timings_csv: csv([data.columns, ...this.rows.map(row => data.columns.map(name => row[name] ?? ''))]),
      samples_csv: csv([[...names, 'round', 'steps', 'ms_per_step', 'outlier'], ...this.rows.flatMap(row =>
        row.samples.map((ms, i) => [...names.map(name => row[name]), i + 1, row.steps, ms, '']))]),
    }, null, 1);
  }
}
