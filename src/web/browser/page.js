// What the page shows, and the buttons. ?auto=SCENE,... measures at once, and sends the results to mssim web --serve; further
// settings in the address: integrators=NAME,..., rounds=N, seconds=S (of a sample), threads=N, webgpu=no.
'use strict';

const element = id => document.getElementById(id);
const address = new URLSearchParams(location.search);
const listIn = name => (address.get(name) || '').split(',').filter(Boolean);
const ranges = {rounds: [1, 100], threads: [2, 99], seconds: [0.001, 10]};
/** The number of a setting in the address: undefined if it is not there, NaN if it is out of its range. */
function numberIn(name) {
  if (!address.has(name)) return undefined;
  const number = Number(address.get(name)), [least, most] = ranges[name];
  return number >= least && number <= most && (name === 'seconds' || Number.isInteger(number)) ? number : NaN;
}
/** Three significant digits, without an exponent. */
const digits = value => value.toPrecision(3).includes('e') ? Number(value.toPrecision(3)).toString() : value.toPrecision(3);
const create = (tag, properties = {}, ...children) => {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
};
const {build} = data.provenance, keptAs = JSON.stringify(build);
let session, adapter, lock, shown;

// The device.

async function openDevice() {
  if (address.get('webgpu') === 'no' || !navigator.gpu) return null;
  adapter = await navigator.gpu.requestAdapter({powerPreference: 'high-performance'});
  // The most that the adapter offers, so that no default limit shuts out a scene.
  const wanted = ['maxStorageBufferBindingSize', 'maxBufferSize'];
  return adapter && adapter.requestDevice({requiredLimits: Object.fromEntries(wanted.map(name => [name, adapter.limits[name]]))});
}

function adapterName() {
  const {description, vendor, architecture, device} = adapter?.info || {};
  return description || [vendor, architecture, device].filter(Boolean).join(' ') || 'an adapter without a name';
}

function missingWebGpu() {
  if (!isSecureContext) return 'WebGPU needs a page from https or from localhost, and this page is from neither.';
  if (!navigator.gpu) return 'This browser has no WebGPU.';
  return 'This browser has WebGPU, but offers no adapter.';
}

async function about() {
  const hints = await navigator.userAgentData?.getHighEntropyValues?.(['model', 'platformVersion', 'fullVersionList']).catch(() => 0) || {};
  const system = [hints.platform, hints.platformVersion].filter(Boolean).join(' ') || navigator.platform || 'an unnamed system';
  return {
    settings: [location.search].filter(Boolean), device: hints.model || `a device with ${system}`, system,
    browser: navigator.userAgent, logicalCpus: navigator.hardwareConcurrency || 0, memoryBytes: (navigator.deviceMemory || 0) * 2 ** 30,
    adapters: adapter ? [`WebGPU: ${adapterName()}`] : [],
    limits: adapter ? [`adapter limits ${['maxStorageBufferBindingSize', 'maxBufferSize', 'maxComputeWorkgroupsPerDimension']
      .map(name => `${name} ${adapter.limits[name]}`).join(', ')}`] : [],
  };
}

// Results.

function showRows({rows}) {
  element('rows').replaceChildren(...rows.map(row => {
    const scene = data.scenes.find(({name}) => name === row.scene);
    const {paper_name} = data.integrators.find(({name}) => name === row.integrator);
    const published = name => scene.published[paper_name]?.[name];
    const together = published('gpu+multi-thread-cpu'), timed = row.status === 'ok' && row.ms_per_step;
    const verdict = row.verified ? `verified, error ${digits(row.position_error)}` : row.status === 'ok' ? '' : row.status;
    return create('tr', {}, create('th', {scope: 'row', textContent: `${row.scene} (${row.nodes.toLocaleString('en')})`}), ...[
      row.integrator, row.threads > 1 ? `${row.backend} (${row.threads})` : row.backend, timed ? digits(row.ms_per_step) : '', timed && row.rounds > 5 ? `${digits(row.ms_per_step_low)} to ${digits(row.ms_per_step_high)}` : '',
      timed && row.speedup ? `${digits(row.speedup)}×` : '', timed && row.drift ? row.drift.toFixed(2) : '',
      published('cpu-only') ?? '', published('gpu') ?? (together ? `${together} with threads` : ''),
      row.verified && row.status !== 'ok' ? `${verdict}; ${row.status}` : verdict,
    ].map((text, i) => create('td', {textContent: text, className: i === 8 && !row.verified ? 'bad' : ''})));
  }));
}

/** The speed-ups of cloths over one thread, published and measured: the chart of Table 1. */
function showChart({rows}) {
  const cloths = data.scenes.filter(({kind}) => kind === 'cloth'), name = 'semi-euler', lines = [];
  const add = (label, colour, dash, of) => {
    const points = cloths.map(scene => [scene.nodes, of(scene)]).filter(([, value]) => value > 0);
    if (points.length) lines.push({label, colour, dash, points});
  };
  for (const configuration of ['gpu', 'multi-thread-cpu'])
    add(`published ${configuration === 'gpu' ? 'GPU' : 'threads'}, ${data.paper_device}`, 'var(--two)', configuration === 'gpu' ? '' : '3 4',
        ({published}) => published[name]?.['cpu-only'] / published[name]?.[configuration]);
  for (const [backend, dash] of [['webgpu', ''], ['wasm-threads', '3 4'], ['wasm', '1 5']])
    add(`${backend} here`, 'var(--one)', dash, scene => rows.find(row =>
      row.scene === scene.name && row.integrator === name && row.backend === backend && row.status === 'ok')?.speedup);
  const all = lines.flatMap(({points}) => points.map(([, value]) => value));
  if (!lines.some(({label}) => label.endsWith('here'))) return element('chart').replaceChildren();
  const width = Math.max(300, Math.min(element('chart').clientWidth, 720)), height = 320, left = 48, log = (value, [low, high]) => Math.log(value / low) / Math.log(high / low);
  const xs = [2000, 400000], ys = [Math.min(1, ...all) / 1.2, Math.max(...all) * 1.2];
  const x = nodes => left + (width - left - 24) * log(nodes, xs), y = value => height - 32 - (height - 44 - 16 * lines.length) * log(value, ys);
  let svg = '';
  for (const nodes of [2500, 10000, 40000, 350000])
    svg += `<text x="${x(nodes)}" y="${height - 12}" text-anchor="middle">${nodes.toLocaleString('en')}</text>`;
  for (let value = 10 ** Math.ceil(Math.log10(ys[0])); value <= ys[1]; value *= 10)
    svg += `<text x="${left - 6}" y="${y(value) + 4}" text-anchor="end">${value}×</text>` +
      `<line x1="${left}" x2="${width}" y1="${y(value)}" y2="${y(value)}" stroke="var(--line)" stroke-width="0.5"/>`;
  lines.forEach(({label, colour, dash, points}, i) => {
    svg += `<polyline fill="none" stroke="${colour}" stroke-width="2.5" stroke-dasharray="${dash}" points="${points.map(([nodes, value]) => `${x(nodes)},${y(value)}`).join(' ')}"/>` +
      points.map(([nodes, value]) => `<circle r="4" cx="${x(nodes)}" cy="${y(value)}" fill="${colour}"/>`).join('') +
      `<line x1="${left}" x2="${left + 28}" y1="${12 + 16 * i}" y2="${12 + 16 * i}" stroke="${colour}" stroke-width="2.5" stroke-dasharray="${dash}"/>` +
      `<text x="${left + 34}" y="${16 + 16 * i}">${label}</text>`;
  });
  element('chart').innerHTML = `<figcaption>Cloth, ${name}: times as fast as one thread, against nodes. The table has the numbers.</figcaption>` +
    `<svg viewBox="0 0 ${width} ${height}" role="img" aria-label="Speed-ups of cloths over one thread, published and measured">${svg}</svg>`;
}

function show(its) {
  const left = its.left();
  // A screen reader says each new state: those are few.
  const end = its.endedEarly ? 'Ended early' : 'Done';
  const state = its.finished ? `${end}: ${its.rows.filter(row => row.verified).length} of ${its.rows.length} rows are verified.`
    : `Measures ${its.scene}.`;
  if (element('state').textContent !== state) element('state').textContent = state;
  element('left').textContent = its.finished ? ''
    : its.what + (left > 0 ? `; about ${left < 90000 ? `${Math.ceil(left / 1000)} s` : `${Math.ceil(left / 60000)} min`} left` : '');
  element('bar').value = its.finished && !its.endedEarly ? 1 : its.done / its.units;
  const notes = its.drift() > 1.05 ? [...its.notes, `a row became ${((its.drift() - 1) * 100).toFixed(0)} % slower over its rounds: the device may be hot`] : its.notes;
  element('notes').replaceChildren(...notes.map(note => create('li', {textContent: note})));
  const seen = JSON.stringify(its.rows.map(({status, verified, ms_per_step}) => [status, verified, ms_per_step]));
  if (seen !== shown) {
    shown = seen;
    showRows(its);
    showChart(its);
  }
  for (const id of ['save', 'send']) element(id).disabled = !its.rows.some(row => row.samples.length || row.status !== 'ok');
  const {notes: said, started, finished, endedEarly, done, units, rows} = its;
  try {
    sessionStorage.setItem(keptAs, JSON.stringify({notes: said, started, finished, endedEarly, done, units, rows: rows.map(({backend_, ...row}) => row)}));
  } catch {}  // some browsers forbid it, for example in private windows
}

/** The rows of this tab, if the browser has ended the page since: phones end pages that they hide. */
function showKept() {
  let kept = null;
  try { kept = JSON.parse(sessionStorage.getItem(keptAs)); } catch {}
  if (!kept) return;
  session = Object.assign(Object.create(Session.prototype), kept, {finished: true});
  if (!kept.finished) {
    session.endedEarly = true;
    session.notes.push('the page was loaded again during the measurement, which ended');
  }
  session.summarise();
  show(session);
}

// The cloth, while nothing is timed.

async function animate() {
  const scene = data.scenes[0], integrator = data.integrators[0], system = buildSystem(scene), {rows, columns} = scene.grid;
  const backend = new ListBackend(system, integrator, scene.dt, Float32Array), canvas = element('cloth'), pen = canvas.getContext('2d');
  await backend.setState(system.start);
  const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
  let frame = 0;
  const draw = () => {
    if (!session || session.finished) {
      if (frame++ > 1500) backend.setState(system.start), frame = 0;
      backend.steps(backend.list, still ? 2000 : 30);
      const at = backend.list.pairs[0], place = node => {
        const x = at[6 * node] - 0.245, y = at[6 * node + 1], z = at[6 * node + 2];
        return [320 + 560 * (0.9 * x - 0.35 * z), 270 - 480 * y - 90 * (z + 0.3 * x)];
      };
      pen.clearRect(0, 0, canvas.width, canvas.height);
      pen.strokeStyle = getComputedStyle(document.body).color;
      pen.lineWidth = 0.6;
      pen.beginPath();
      for (let row = 0; row < rows; ++row)
        for (let column = 0; column < columns; ++column) {
          const node = row * columns + column;
          if (column + 1 < columns) pen.moveTo(...place(node)), pen.lineTo(...place(node + 1));
          if (row + 1 < rows) pen.moveTo(...place(node)), pen.lineTo(...place(node + columns));
        }
      pen.stroke();
    }
    if (!still) requestAnimationFrame(draw);
  };
  draw();
}

// Buttons.

// A phone that sleeps ends the measurement. A page that was hidden has lost its lock.
const stayAwake = async () => lock = await navigator.wakeLock?.request('screen').catch(() => null);
document.addEventListener('visibilitychange', () => !document.hidden && session && !session.finished && stayAwake());

const chosen = id => [...element(id).querySelectorAll('input:checked')].map(({value}) => value);

async function measure() {
  const options = {scenes: chosen('scenes'), integrators: chosen('integrators'), rounds: Number(element('rounds').value) || 10,
                   sampleSeconds: numberIn('seconds') ?? 0.1, threads: numberIn('threads') ?? (navigator.hardwareConcurrency || 1)};
  if (session && !session.finished) return;
  if (!options.scenes.length || !options.integrators.length) return void (element('state').textContent = 'Choose a scene and an integrator.');
  element('stop').disabled = false;
  if (document.activeElement === element('start')) element('stop').focus();
  element('start').disabled = true;
  const device = await openDevice().catch(() => null);
  await stayAwake();
  session = new Session(options, device, adapterName(), show);
  if (address.get('lose')) setTimeout(() => device?.destroy(), 1000 * Number(address.get('lose')));
  show(session);
  await session.run();
  lock?.release();
  device?.destroy();
  element('start').disabled = false;
  element('stop').disabled = true;
}

async function send() {
  const answer = await fetch('/results', {method: 'POST', body: session.results(await about())}).catch(error => error);
  // Another server than mssim's answers with a page.
  const said = !answer.headers ? answer.message
    : answer.headers.get('content-type')?.startsWith('text/plain') ? await answer.text() : `${answer.status} ${answer.statusText}`;
  element('sent').textContent = answer.ok ? `mssim has written ${said}.` : `mssim has not taken them: ${said}`;
}

element('choices').addEventListener('submit', event => {
  event.preventDefault();
  measure();
});
addEventListener('resize', () => session && showChart(session));
element('stop').addEventListener('click', () => session.stopping = true);
element('save').addEventListener('click', async () => {
  const url = URL.createObjectURL(new Blob([session.results(await about())], {type: 'application/json'}));
  create('a', {href: url, download: `mssim-web-${session.started.replaceAll(':', '-')}.json`}).click();
  setTimeout(() => URL.revokeObjectURL(url), 60000);
});
element('send').addEventListener('click', send);
// By mssim web --serve; results go nowhere else.
const isServed = data.served;
element('send').hidden = !isServed;

/** Why the settings in the address cannot be used; empty if they can. */
function wrongSetting() {
  const unknown = (name, known) => listIn(name).filter(value => !known.some(one => one.name === value)).map(value => `${name} ${value}`);
  const beyond = Object.entries(ranges).filter(([name]) => Number.isNaN(numberIn(name)))
    .map(([name, [least, most]]) => `${name} ${address.get(name)} (${least} to ${most})`);
  const names = ['auto', 'integrators', 'webgpu', 'lose', ...Object.keys(ranges)];
  const other = [...address].filter(([name, value]) => !names.includes(name) || (name === 'webgpu' && value !== 'no')).map(pair => pair.join(' '));
  const all = [...unknown('auto', data.scenes), ...unknown('integrators', data.integrators), ...beyond, ...other];
  return all.length ? `The address has settings that this page does not know: ${all.join(', ')}. Change them, and load the page again.` : '';
}

const box = (value, checked) => create('label', {}, create('input', {type: 'checkbox', value, checked}), value);
const [autoScenes, integrators] = [listIn('auto'), listIn('integrators')];
element('scenes').append(...data.scenes.map(({name}) => box(name, !autoScenes.length || autoScenes.includes(name))));
element('integrators').append(...data.integrators.map(({name, paper_name}) =>
  box(name, integrators.length ? integrators.includes(name) : name === paper_name)));
if (numberIn('rounds')) element('rounds').value = numberIn('rounds');
const wrong = wrongSetting();
if (wrong) element('state').textContent = wrong;
element('start').disabled = Boolean(wrong);
if (!data.wasm) element('module').textContent = `In this page, ${missingModule}.`;
element('version').textContent = `Made by mssim ${build.version}, commit ${build.commit.slice(0, 12)}${build.dirty ? ' with changes' : ''}.`;

(async () => {
  const device = await openDevice().catch(() => null);
  element('support').textContent = device ? `WebGPU runs on ${adapterName()}.` : `${missingWebGpu()} Only the CPU will be measured.`;
  device?.destroy();
  await animate();
  if (wrong) return;
  if (!autoScenes.length) return showKept();
  await measure();
  if (isServed) await send();
})();
