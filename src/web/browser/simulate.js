// Scenes, laws, and the backends. The laws are the text of kernels/, translated; the stages are those of mssim's table of
// integrators; `data` has both (src/web/page.cpp).
'use strict';

const unpack = (text, Type) => new Type(Uint8Array.from(atob(text), character => character.charCodeAt(0)).buffer);

/** A text of kernels/ (the common subset of C++ and OpenCL C) as functions of WGSL, or of JavaScript with {x, y, z} as vectors. */
function translateLaws(text, isWgsl) {
  const types = {Real: 'f32', Vector: 'vec3f'};
  const plain = text.replace(/\/\*[\s\S]*?\*\//g, '').replace(/MSSIM_OF\((\w+)\)/g, '$1');
  let result = '';
  for (const [, vector, name, list, body] of plain.matchAll(/MSSIM_(VECTOR_)?LAW (\w+)\(([^)]*)\) \{\n([\s\S]*?)\n\}/g)) {
    const parameters = list.split(',').map(parameter => parameter.trim().split(/\s+/));
    if (isWgsl)
      result += `fn ${name}(${parameters.map(([type, it]) => `${it}: ${types[type] || type}`)}) -> ${vector ? 'vec3f' : 'f32'} {\n` +
        body.replace(/Vector (\w+) = \{([^}]*)\}/g, 'var $1 = vec3f($2)').replace(/(?:Vector|Real) (\w+) =/g, 'var $1 =') + '\n}\n';
    else
      result += `function ${name}(${parameters.map(([, it]) => it)}) {\n` +
        body.replace(/Vector (\w+) = \{([^}]*)\}/g, 'let $1 = vector($2)').replace(/Vector (\w+) = (\w+);/g, 'let $1 = {...$2};')
          .replace(/Real (\w+) =/g, 'let $1 =').replace(/(\d\.?\d*(?:e-?\d+)?)f\b/g, '$1') + '\n}\n';
  }
  return result;
}

const lawsInWgsl = () => `struct SpringConstants { ${data.spring_constants.map(name => `${name}: f32`).join(', ')} }
struct LinearSpring { constants: SpringConstants, stiffness_rest: f32 }
fn mul_add(a: f32, b: f32, c: f32) -> f32 { return a * b + c; }
fn inverse_sqrt(a: f32) -> f32 { return 1.0 / sqrt(a); }
fn where_less(a: f32, b: f32, yes: f32, no: f32) -> f32 { return select(no, yes, a < b); }
fn dot_product(a: vec3f, b: vec3f) -> f32 { return dot(a, b); }
` + data.laws.map(text => translateLaws(text, true)).join('');

const lawsInJavascript = () => `'use strict';
const vector = (x, y, z) => ({x, y, z}), dot_product = (a, b) => a.x * b.x + a.y * b.y + a.z * b.z;
const mul_add = (a, b, c) => a * b + c, inverse_sqrt = a => 1 / Math.sqrt(a), where_less = (a, b, yes, no) => a < b ? yes : no;
` + data.laws.map(text => translateLaws(text, false)).join('');

/** The pairs and slots of a stage: what it reads from memory besides the gathered pair, and what it writes. */
function useOfStage(stage) {
  const memory = new Set(data.memory_slots), written = new Set(), read = new Set();
  const gathered = data.memory_slots.slice(2 * stage.gather, 2 * stage.gather + 2);
  for (const {out, terms} of stage.assignments) {
    for (const [, , slot] of terms) if (memory.has(slot) && !written.has(slot) && !gathered.includes(slot)) read.add(slot);
    if (memory.has(out)) written.add(out);
  }
  return {gathered, read: [...read], written: [...written]};
}
const pairOf = slot => data.memory_slots.indexOf(slot) >> 1, partOf = slot => data.memory_slots.indexOf(slot) % 2;
const coefficientOf = ([coefficient, power], dt) => coefficient * dt ** power;

/** The sum of an assignment, its large first term added last. */
const sumOfTerms = (terms, product) =>
  terms.length === 1 ? product(terms[0]) : `${product([1, 0, terms[0][2]])} + (${terms.slice(1).reverse().map(product).join(' + ')})`;

// Systems.

/** A system as the backends need it, from a scene's data; `start` and `floor` replace its own. */
function buildSystem(scene, start = scene.start, floor = scene.floor) {
  const n = scene.nodes, pins = new Set(scene.pins);
  const system = {...scene, floor, pins, free: Uint8Array.from({length: n}, (_, node) => pins.has(node) ? 0 : 1)};
  system.mass = new Float64Array(n);
  system.materials = scene.materials.map(values => Object.fromEntries(values.map((value, i) => [data.spring_constants[i], value])));
  if (scene.grid) {
    const {rows, columns, rest_lengths, node_mass} = scene.grid, first = [], second = [], kind = [];
    for (let row = 0; row < rows; ++row)
      for (let column = 0; column < columns; ++column)
        for (const [down, right, of] of data.stencil)
          if (row + down >= 0 && row + down < rows && column + right < columns) {
            first.push(row * columns + column);
            second.push((row + down) * columns + column + right);
            kind.push(of);
          }
    Object.assign(system, {first: Uint32Array.from(first), second: Uint32Array.from(second), kind: Uint8Array.from(kind)});
    system.restLengths = Float64Array.from(kind, of => rest_lengths[of]);
    system.mass.fill(node_mass);
  } else {
    const ends = [], rest = [];
    let begin = 0;
    for (const [number, mass] of scene.bodies) {
      const shape = data.shapes[number];
      for (const end of unpack(shape.ends, Uint32Array)) ends.push(begin + end);
      for (const length of unpack(shape.rest_lengths, Float32Array)) rest.push(length);
      system.mass.fill(mass, begin, begin += shape.nodes);
    }
    system.first = Uint32Array.from(rest, (_, i) => ends[2 * i]);
    system.second = Uint32Array.from(rest, (_, i) => ends[2 * i + 1]);
    system.restLengths = Float64Array.from(rest);
    system.kind = new Uint8Array(rest.length);
  }
  system.start = start.position ? {position: Float64Array.from(unpack(start.position, Float32Array)),
                                   velocity: Float64Array.from(unpack(start.velocity, Float32Array))}
                                : rippledStart(scene, start, pins);
  return system;
}

/** The start of a cloth (src/scene/cloth.cpp). Throws if it is not mssim's. */
function rippledStart({nodes, grid: {rows, columns}}, ripple, pins) {
  const wave = 2 * Math.PI / ripple.wavelength;
  const sines = (count, axis) => Array.from({length: count}, (_, i) =>
    ripple.phases.map(phase => Math.sin(wave * (i * ripple.spacing) + phase[axis])));
  const along = sines(columns, 0), down = sines(rows, 1), share = [ripple.in_plane_share, 1, ripple.in_plane_share];
  const start = {position: new Float64Array(3 * nodes), velocity: new Float64Array(3 * nodes)};
  for (let node = 0; node < nodes; ++node) {
    const row = Math.floor(node / columns), column = node % columns;
    const level = [column * ripple.spacing, ripple.ceiling, row * ripple.spacing];
    for (let c = 0; c < 3; ++c) {
      const moves = pins.has(node) ? 0 : 1;
      start.position[3 * node + c] = Math.fround(level[c] + moves * ripple.height * share[c] * along[column][c] * down[row][c]);
      start.velocity[3 * node + c] = Math.fround(moves * ripple.speed * along[column][c + 3] * down[row][c + 3]);
    }
  }
  for (const [node, x, v] of ripple.some_nodes)
    for (let c = 0; c < 3; ++c)
      if (Math.abs(start.position[3 * node + c] - x[c]) + Math.abs(start.velocity[3 * node + c] - v[c]) > 1e-6)
        throw new Error(`node ${node} of this cloth does not start where mssim starts it`);
  return start;
}

/** A state moved by `seconds` along its velocities. On the way back, a node that this would move below the floor is put on it
 *  (step_ahead in src/backends/interface/backend.h). */
function moved({position, velocity}, seconds, floor = -Infinity) {
  if (seconds === 0) return {position, velocity};
  return {velocity, position: position.map((x, i) => {
    const to = x + seconds * velocity[i];
    return i % 3 === 1 && x >= floor ? Math.max(to, floor) : to;
  })};
}

// The memory of a backend has number c (x, y, z, u, v, w) of a node at index at(node, c).

function store({position, velocity}, memory, at) {
  for (let i = 0; i < position.length; ++i) {
    memory[at(Math.floor(i / 3), i % 3)] = position[i];
    memory[at(Math.floor(i / 3), i % 3 + 3)] = velocity[i];
  }
}
function stateIn(memory, at, nodes) {
  const state = {position: new Float64Array(3 * nodes), velocity: new Float64Array(3 * nodes)};
  for (let i = 0; i < 3 * nodes; ++i) {
    state.position[i] = memory[at(Math.floor(i / 3), i % 3)];
    state.velocity[i] = memory[at(Math.floor(i / 3), i % 3 + 3)];
  }
  return state;
}

// The plain list of springs in typed arrays.

/** Compiles the steps of an integrator: a function of the list and a number of steps. */
function compileList(integrator, dt) {
  const xyz = [0, 1, 2];
  let text = `${lawsInJavascript()}
return function (list, count) {
  const {nodes, first, second, kind, free, stiffnessRest, inverseMass, force, materials, viscous_damping, gravity, pairs} = list;
  const [height, restitution, friction] = list.floor, spring = {constants: materials[0], stiffness_rest: 0};
  for (let step = 0; step < count; ++step) {\n`;
  integrator.stages.forEach((stage, number) => {
    const {gathered, read, written} = useOfStage(stage);
    const at = (slot, c) => `pairs[${pairOf(slot)}][n + ${3 * partOf(slot) + c}]`;
    text += `    { const from = pairs[${stage.gather}];
      force.fill(0);
      for (let s = 0; s < first.length; ++s) {
        const one = first[s], other = second[s], i = 6 * one, j = 6 * other;
        const dx = from[j] - from[i], dy = from[j + 1] - from[i + 1], dz = from[j + 2] - from[i + 2];
        const closing = (from[j + 3] - from[i + 3]) * dx + (from[j + 4] - from[i + 4]) * dy + (from[j + 5] - from[i + 5]) * dz;
        spring.constants = materials[kind[s]];
        spring.stiffness_rest = stiffnessRest[s];
        const pull = spring_pull(dx * dx + dy * dy + dz * dz, closing, spring);
        force[3 * one] += pull * dx; force[3 * one + 1] += pull * dy; force[3 * one + 2] += pull * dz;
        force[3 * other] -= pull * dx; force[3 * other + 1] -= pull * dy; force[3 * other + 2] -= pull * dz;
      }
      for (let node = 0; node < nodes; ++node) {
        const n = 6 * node, w = inverseMass[node];\n`;
    for (const slot of new Set([...gathered, ...read])) text += xyz.map(c => `        let ${slot}${c} = ${at(slot, c)};\n`).join('');
    const [, v] = gathered;
    text += `        let a0 = 0, a1 = 0, a2 = 0;
        if (free[node]) {
          const a = node_acceleration(vector(force[3 * node] * w, force[3 * node + 1] * w, force[3 * node + 2] * w),
                                      vector(${xyz.map(c => v + c)}), viscous_damping, gravity);
          a0 = a.x; a1 = a.y; a2 = a.z;
        }\n`;
    const known = new Set([...gathered, ...read]);
    for (const {out, terms} of stage.assignments) {
      for (const c of xyz)
        text += `        ${known.has(out) ? '' : 'let '}${out}${c} = ${sumOfTerms(terms, term => {
          const factor = coefficientOf(term, dt);
          return factor === 1 ? term[2] + c : `${factor} * ${term[2]}${c}`;
        })};\n`;
      known.add(out);
    }
    if (number + 1 === integrator.stages.length)
      text += `        if (free[node] && x_next1 < height) {
          x_next1 = height;
          const after = floor_velocity(vector(v_next0, v_next1, v_next2), restitution, friction);
          v_next0 = after.x; v_next1 = after.y; v_next2 = after.z;
        }\n`;
    for (const slot of written) text += xyz.map(c => `        ${at(slot, c)} = ${slot}${c};\n`).join('');
    text += '      } }\n';
  });
  text += '    [pairs[0], pairs[1]] = [pairs[1], pairs[0]];\n  }\n};';
  return new Function(text)();
}

/** Steps a system on one thread. `Real`: Float32Array for the row `javascript`, Float64Array for the reference. */
class ListBackend {
  constructor(system, integrator, dt, Real) {
    const n = system.nodes;
    this.system = system;
    this.ahead = integrator.ahead * dt;
    this.steps = compileList(integrator, dt);
    this.list = {
      ...system, inverseMass: Real.from(system.mass, mass => 1 / mass), force: new Real(3 * n),
      stiffnessRest: Real.from(system.restLengths, (length, s) => system.materials[system.kind[s]].stiffness * length),
      pairs: Array.from({length: 4}, () => new Real(6 * n)),
    };
  }
  at(node, c) { return 6 * node + c; }
  async setState(state) { store(moved(state, this.ahead), this.list.pairs[0], this.at); }
  async step(count) { this.steps(this.list, count); }
  async state() { return moved(stateIn(this.list.pairs[0], this.at, this.system.nodes), -this.ahead, this.system.floor[0]); }
  destroy() { this.list = null; }
}

/** Shares the nodes of a system among threads, in ranges [begin, end) with about as many springs each. A thread gets all springs
 *  that pull at its nodes; they touch nodes of [low, high). */
function sharesOf({nodes, first, second}, threads) {
  const springs = new Uint32Array(nodes), owner = new Uint32Array(nodes), all = 2 * first.length;
  for (const ends of [first, second]) for (const node of ends) ++springs[node];
  for (let node = 0, before = 0; node < nodes; before += springs[node++])
    owner[node] = Math.min(Math.floor(before * threads / all), threads - 1);
  const shares = Array.from({length: threads}, (_, thread) => {
    const begin = owner.filter(its => its < thread).length, end = owner.filter(its => its <= thread).length;
    return {begin, end, low: begin, high: end, springs: []};
  });
  for (let s = 0; s < first.length; ++s) {
    const one = shares[owner[first[s]]], other = shares[owner[second[s]]];
    for (const share of one === other ? [one] : [one, other]) {
      share.springs.push(s);
      share.low = Math.min(share.low, first[s], second[s]);
      share.high = Math.max(share.high, first[s] + 1, second[s] + 1);
    }
  }
  return shares;
}

/** A thread of the module: its first message makes it, others are numbers of steps. It answers each. */
const wasmWorker = `onmessage = ({data: {module, memory, thread, stack}}) => {
  const {exports} = new WebAssembly.Instance(module, {env: {memory, pow: Math.pow}});
  exports.__stack_pointer.value = stack;
  onmessage = ({data: count}) => postMessage(exports.step(thread, count));
  postMessage(0);
};`;

/** The same list in WebAssembly (src/web/module/spring_list.cpp): single precision, four springs at a time. Several threads are
 *  workers, and share a memory; only a page that is isolated from other origins may do so. */
class WasmBackend {
  /** Throws an Error whose message is the reason if the browser has no such WebAssembly, or too little memory. */
  static async make(system, integrator, dt, threads) {
    const n = system.nodes, names = data.spring_constants, backend = new WasmBackend();
    const unsupported = message => { throw new Error(`unsupported: ${message}`); };
    const given = address => address ||
      unsupported(`the browser has too little memory for ${n} nodes and ${system.first.length} springs in WebAssembly`);
    let module, memory, exports;
    try {
      module = await WebAssembly.compile(unpack(threads > 1 ? data.wasm_threads : data.wasm, Uint8Array));
      // Browsers may reserve a shared memory whole. This is enough if the integrator has all pairs, each thread has forces of all nodes,
      // and each spring is computed twice.
      const most = 2 ** 21 + 65536 * threads + n * (132 + 16 * threads) + 2 * 4 * (3 + names.length) * system.first.length;
      memory = new WebAssembly.Memory({initial: 16, maximum: Math.ceil(most / 65536), shared: threads > 1});
      exports = (await WebAssembly.instantiate(module, {env: {memory, pow: Math.pow}})).exports;
    } catch (error) { unsupported(error.message); }
    const head = given(exports.prepare(data.integrators.indexOf(integrator), dt, n, threads, system.viscous_damping, system.gravity,
                                       ...system.floor));
    // Four springs: their first ends, their second ends, each constant of the law, stiffness_rest. The last four are filled up with
    // springs that pull at nothing.
    const words = 4 * (3 + names.length);
    sharesOf(system, threads).forEach(({springs, begin, end, low, high}, thread) => {
      const count = springs.length, groups = Math.ceil(count / 4);
      const address = given(exports.share(thread, count, begin, end, low, high)), {buffer} = memory;
      const ends = new Uint32Array(buffer, address, words * groups), laws = new Float32Array(buffer, address, words * groups);
      for (let i = 0; i < 4 * groups; ++i) {
        const s = springs[Math.min(i, count - 1)], at = words * (i >> 2) + i % 4, material = system.materials[system.kind[s]];
        ends[at] = system.first[s];
        ends[at + 4] = system.second[s];
        if (i >= count) continue;
        names.forEach((name, c) => laws[at + 8 + 4 * c] = material[name]);
        laws[at + words - 4] = material.stiffness * system.restLengths[s];
      }
    });
    const [masses] = new Uint32Array(memory.buffer, head + 16, 1);
    new Float32Array(memory.buffer, masses, n).set(system.mass.map((mass, node) => system.free[node] / mass));
    Object.assign(backend, {memory, exports, head, system, ahead: integrator.ahead * dt, workers: []});
    if (threads > 1) {
      const stacks = Array.from({length: threads}, () => given(exports.stack()));
      const text = URL.createObjectURL(new Blob([wasmWorker], {type: 'text/javascript'}));
      backend.workers = stacks.map(() => new Worker(text));
      await backend.ask(thread => ({module, memory, thread, stack: stacks[thread]})).catch(error => {
        backend.destroy();
        throw error;
      }).finally(() => URL.revokeObjectURL(text));
    }
    return backend;
  }
  /** Sends each worker a message, and waits for all answers. */
  async ask(messageTo) {
    await Promise.all(this.workers.map((worker, thread) => new Promise((resolve, reject) => {
      worker.onmessage = resolve;
      worker.onerror = ({message}) => reject(new Error(`a thread ended: ${message || 'the browser does not say why'}`));
      worker.postMessage(messageTo(thread));
    })));
  }
  at(node, c) { return 8 * node + c + (c > 2); }
  /** Those that the integrator has, the state first. */
  pairs() {
    const {buffer} = this.memory;
    return [...new Uint32Array(buffer, this.head, 4)].filter(Boolean).map(pair => new Float32Array(buffer, pair, 8 * this.system.nodes));
  }
  async setState(state) { for (const pair of this.pairs()) store(moved(state, this.ahead), pair, this.at); }  // pinned nodes stay in all
  async step(count) {
    if (this.workers.length) await this.ask(() => count);
    else this.exports.step(0, count);
  }
  async state() { return moved(stateIn(this.pairs()[0], this.at, this.system.nodes), -this.ahead, this.system.floor[0]); }
  destroy() {
    for (const worker of this.workers) worker.terminate();
    this.exports = this.memory = null;
  }
}

// WebGPU: an invocation owns a node, gathers its springs and runs a stage's assignments. A pair is an array of nodes, two vec4f
// each: position and 1 for a node that may move, 0 for a pinned one; velocity.

const workgroup = 64, sliceLanes = 32;
const f32 = number => `(${Math.fround(number)}f)`;
const linearSpring = (material, mass, rest) =>
  `LinearSpring(SpringConstants(${data.spring_constants.map(name => f32(material[name] / mass))}), ${f32(material.stiffness * rest / mass)})`;

/** Springs of a grid: both ends of every spring of the stencil. All nodes have the same mass. */
function gatherGrid({grid, materials, mass}) {
  let text = `fn gather_springs(i: u32, x: vec3f, v: vec3f) -> vec3f {
  let row = i32(i) / ${grid.columns};
  let column = i32(i) % ${grid.columns};
  var sum = vec3f();\n`;
  for (const [down, right, kind] of data.stencil)
    for (const end of [1, -1]) {
      const r = end * down, c = end * right;
      text += `  if (row + ${r} >= 0 && row + ${r} < ${grid.rows} && column + ${c} >= 0 && column + ${c} < ${grid.columns}) {
    sum += spring_force(u32(i32(i) + ${r * grid.columns + c}), x, v, ${linearSpring(materials[kind], mass[0], grid.rest_lengths[kind])});
  }\n`.replaceAll('+ -', '- ');
    }
  return text + '  return sum;\n}\n';
}

const gatherSlices = `fn gather_springs(i: u32, x: vec3f, v: vec3f) -> vec3f {
  var sum = vec3f();
  for (var entry = first_entry[i / ${sliceLanes}u]; entry < first_entry[i / ${sliceLanes}u + 1u]; entry++) {
    let spring = entries[entry * ${sliceLanes}u + i % ${sliceLanes}u];
    let stiffness_rest = bitcast<f32>(spring.y);
    if (stiffness_rest >= 0) { sum += spring_force(spring.x, x, v, LinearSpring(constants[i], stiffness_rest)); }
  }
  return sum;
}\n`;

/** The springs of bodies by node, in slices of as many nodes as hardware reads at once; nodes with equally many springs share a
 *  slice. Like SlicedGraph (src/backends/layouts/sliced_graph.h). */
function sliceSprings(system) {
  const n = system.nodes, springs = Array.from({length: n}, () => []);
  for (let s = 0; s < system.first.length; ++s) {
    springs[system.first[s]].push([system.second[s], s]);
    springs[system.second[s]].push([system.first[s], s]);
  }
  const order = Array.from({length: n}, (_, node) => node).sort((a, b) => springs[b].length - springs[a].length || a - b);
  const place = new Uint32Array(n);
  order.forEach((node, i) => place[node] = i);
  const firstEntry = [0];
  for (let i = 0; i < n; i += sliceLanes) firstEntry.push(firstEntry.at(-1) + springs[order[i]].length);
  const entries = new Uint32Array(2 * sliceLanes * firstEntry.at(-1)), rest = new Float32Array(entries.buffer).fill(-1);
  const names = data.spring_constants, constants = new Float32Array(names.length * n);
  order.forEach((node, i) => {
    const mass = system.mass[node];
    names.forEach((name, c) => constants[names.length * i + c] = system.materials[0][name] / mass);
    springs[node].forEach(([other, s], number) => {
      const at = 2 * ((firstEntry[Math.floor(i / sliceLanes)] + number) * sliceLanes + i % sliceLanes);
      entries[at] = place[other];
      rest[at + 1] = system.materials[0].stiffness * system.restLengths[s] / mass;
    });
  });
  return {place, buffers: [
    ['first_entry', 'array<u32>', Uint32Array.from(firstEntry)], ['entries', 'array<vec2u>', entries],
    ['constants', 'array<SpringConstants>', constants]]};
}

/** The program of a stage, and the pairs that it binds. `buffers`: of the topology. */
function stageInWgsl(system, integrator, number, dt, buffers) {
  const stage = integrator.stages[number], {gathered: [x, v], read, written} = useOfStage(stage);
  const writtenPairs = new Set(written.map(pairOf));
  const pairs = [...new Set([stage.gather, ...read.map(pairOf), ...writtenPairs])].sort();
  const bindings = pairs.map(pair => [`pair_${pair}`, 'array<vec4f>', writtenPairs.has(pair) ? 'read_write' : 'read'])
    .concat(buffers.map(([name, type]) => [name, type, 'read']));
  const at = slot => `pair_${pairOf(slot)}[2u * i + ${partOf(slot)}u]`;
  const known = new Set([x, v, ...read, 'a']), [height, restitution, friction] = system.floor;
  let text = lawsInWgsl() + bindings.map(([name, type, access], i) =>
    `@group(0) @binding(${i}) var<storage, ${access}> ${name}: ${type};\n`).join('') + `
fn spring_force(other: u32, x: vec3f, v: vec3f, spring: LinearSpring) -> vec3f {
  let d = pair_${stage.gather}[2u * other].xyz - x;
  return spring_pull(dot(d, d), dot(pair_${stage.gather}[2u * other + 1u].xyz - v, d), spring) * d;
}
${system.grid ? gatherGrid(system) : gatherSlices}
@compute @workgroup_size(${workgroup})
fn main(@builtin(global_invocation_id) id: vec3u) {
  let i = id.x;
  if (i >= ${system.nodes}u) { return; }
  let is_free = ${at(x)}.w;
  var ${x} = ${at(x)}.xyz;
  var ${v} = ${at(v)}.xyz;
${read.map(slot => `  var ${slot} = ${at(slot)}.xyz;\n`).join('')}
  var a = node_acceleration(gather_springs(i, ${x}, ${v}), ${v}, ${f32(system.viscous_damping)}, ${f32(system.gravity)});
  if (is_free == 0) { a = vec3f(); }\n`;
  for (const {out, terms} of stage.assignments) {
    text += `  ${known.has(out) ? '' : 'var '}${out} = ${sumOfTerms(terms, term => {
      const factor = coefficientOf(term, dt);
      return factor === 1 ? term[2] : `${f32(factor)} * ${term[2]}`;
    })};\n`;
    known.add(out);
  }
  if (number + 1 === integrator.stages.length)
    text += `  if (is_free != 0 && x_next.y < ${f32(height)}) {
    x_next.y = ${f32(height)};
    v_next = floor_velocity(v_next, ${f32(restitution)}, ${f32(friction)});
  }\n`;
  text += written.map(slot => `  ${at(slot)} = vec4f(${slot}, is_free);\n`).join('') + '}\n';
  return {text, pairs};
}

class WebGpuBackend {
  /** Throws an Error whose message is the reason if the system is too large for the device, or the device is lost. */
  static async make(device, system, integrator, dt) {
    const backend = new WebGpuBackend(), n = system.nodes;
    const sliced = system.grid ? {buffers: []} : sliceSprings(system);
    const bytes = Math.max(32 * n, ...sliced.buffers.map(([, , values]) => values.byteLength));
    for (const limit of ['maxStorageBufferBindingSize', 'maxBufferSize'])
      if (bytes > device.limits[limit])
        throw new Error(`unsupported: it needs a buffer of ${bytes} bytes, and the device's ${limit} is ${device.limits[limit]}`);
    const groups = Math.ceil(n / workgroup);
    if (groups > device.limits.maxComputeWorkgroupsPerDimension)
      throw new Error(`unsupported: it needs ${groups} workgroups, and the device's maxComputeWorkgroupsPerDimension is ` +
                      device.limits.maxComputeWorkgroupsPerDimension);
    const at = (node, c) => 8 * (sliced.place ? sliced.place[node] : node) + c + (c > 2);
    Object.assign(backend, {device, system, groups, at, ahead: integrator.ahead * dt, batch: 1, all: []});
    const usage = GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC | GPUBufferUsage.COPY_DST;
    const buffer = (size, its) => (backend.all.push(device.createBuffer({size, usage: its})), backend.all.at(-1));
    backend.pairs = [];
    backend.reading = buffer(32 * n, GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST);
    const topology = sliced.buffers.map(([, , values]) => {
      const filled = buffer(values.byteLength, usage);
      device.queue.writeBuffer(filled, 0, values);
      return filled;
    });
    const programs = integrator.stages.map((_, number) => stageInWgsl(system, integrator, number, dt, sliced.buffers));
    for (const pair of new Set(programs.flatMap(program => program.pairs))) backend.pairs[pair] = buffer(32 * n, usage);
    const before = performance.now();
    backend.stages = await Promise.all(programs.map(async ({text, pairs}) => {
      const pipeline = await device.createComputePipelineAsync(
        {layout: 'auto', compute: {module: device.createShaderModule({code: text}), entryPoint: 'main'}});
      // After an odd number of steps, `state` and `next` have changed roles.
      const groups = [0, 1].map(odd => device.createBindGroup({
        layout: pipeline.getBindGroupLayout(0),
        entries: [...pairs.map(pair => backend.pairs[odd && pair < 2 ? 1 - pair : pair]), ...topology].map((resource, binding) =>
          ({binding, resource: {buffer: resource}})),
      }));
      return {pipeline, groups};
    }));
    backend.compileSeconds = (performance.now() - before) / 1000;
    return backend;
  }
  async setState(state) {
    if (this.known !== state) {  // samples all start from the same one
      Object.assign(this, {known: state, values: new Float32Array(8 * this.system.nodes)});
      store(moved(state, this.ahead), this.values, this.at);
      this.system.free.forEach((free, node) => this.values[this.at(node, 2) + 1] = free);
    }
    this.device.queue.writeBuffer(this.pairs[0], 0, this.values);
    this.odd = 0;
    await this.device.queue.onSubmittedWorkDone();
  }
  /** Submissions take at most about a fifth of a second: drivers end those that take seconds. Short calls
   *  overstate a step's time, so a submission only grows from call to call; to ten times a call's steps at most, because a coarse
   *  clock may say that they took no time. */
  async step(count) {
    const before = performance.now();
    for (let left = count; left > 0; left -= this.batch) {
      const encoder = this.device.createCommandEncoder(), pass = encoder.beginComputePass();
      const steps = Math.min(left, this.batch);
      for (let step = 0; step < steps; ++step, this.odd = 1 - this.odd)
        for (const {pipeline, groups} of this.stages) {
          pass.setPipeline(pipeline);
          pass.setBindGroup(0, groups[this.odd]);
          pass.dispatchWorkgroups(this.groups);
        }
      pass.end();
      this.device.queue.submit([encoder.finish()]);
    }
    await this.device.queue.onSubmittedWorkDone();
    this.batch = Math.max(this.batch, Math.min(2000, 10 * count, Math.floor(200 * count / (performance.now() - before))));
  }
  async state() {
    const n = this.system.nodes, encoder = this.device.createCommandEncoder();
    encoder.copyBufferToBuffer(this.pairs[this.odd], 0, this.reading, 0, 32 * n);
    this.device.queue.submit([encoder.finish()]);
    await this.reading.mapAsync(GPUMapMode.READ);
    const values = new Float32Array(this.reading.getMappedRange().slice(0));
    this.reading.unmap();
    return moved(stateIn(values, this.at, n), -this.ahead, this.system.floor[0]);
  }
  destroy() { for (const buffer of this.all) buffer.destroy(); }
}
