// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/page_style.hpp"

namespace waymark {

const std::string_view kPageStyle = R"css(
:root {
  color-scheme: light dark;
  --paper: #faf8f4; --card: #fff; --ink: #20262b; --soft: #5d666e; --line: #e2ddd3; --accent: #8a4b1f;
  --warn: #fff4e0; --warn-line: #d9952b; --ground: #d3d7d8;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #14171a; --card: #1c2024; --ink: #e6e3dd; --soft: #a0a7ad; --line: #31373d; --accent: #dea06e;
    --warn: #33291a; --warn-line: #c98b2f; --ground: #3a4044;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; padding: 2.2rem 1.4rem 3rem; max-width: 76rem; background: var(--paper); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif;
}
h1 { margin: 0; font-size: 2rem; line-height: 1.2; letter-spacing: -.015em; }
h2 { margin: 2.8rem 0 .9rem; font-size: 1.3rem; letter-spacing: -.01em; }
h3 { margin: 1.8rem 0 .5rem; font-size: 1rem; }
h2 .symbol { margin-right: .45rem; vertical-align: -.1em; }
p { margin: .3rem 0 .9rem; max-width: 46rem; }
small, .soft, .empty, footer { color: var(--soft); }
header p { margin: .45rem 0 0; color: var(--soft); }
code, pre { font: .84em/1.5 ui-monospace, "SF Mono", "DejaVu Sans Mono", monospace; overflow-wrap: anywhere; }
.facts { display: flex; flex-wrap: wrap; gap: .8rem; margin: 1.5rem 0; padding: 0; list-style: none; }
.facts li {
  flex: 1 1 9.5rem; padding: .75rem 1rem .8rem; background: var(--card); border: 1px solid var(--line); border-radius: 10px;
}
.facts b { display: block; font-size: 1.5rem; line-height: 1.25; font-weight: 650; letter-spacing: -.01em; }
.facts span { color: var(--soft); font-size: .86rem; }
figure { margin: 0; }
.map { padding: 1rem 1rem .8rem .4rem; background: var(--card); border: 1px solid var(--line); border-radius: 12px; }
.map > svg { display: block; width: 100%; max-height: 62rem; margin: 0 auto; }
.ground { fill: var(--ground); }
.frame { fill: none; stroke: var(--ink); stroke-width: 1.2; }
.graticule { fill: none; stroke: #fff; stroke-opacity: .38; stroke-width: .8; }
.coordinates text { fill: var(--soft); font-size: 13px; font-variant-numeric: tabular-nums; }
.marker { fill: var(--type); stroke: #fff; stroke-width: 1; paint-order: stroke fill; }
.marker * { vector-effect: non-scaling-stroke; }
.marker.ring { stroke: var(--type); stroke-width: 1.6; }
.marker.solid { fill-opacity: .93; }
.labels text {
  fill: #1b1f23; stroke: #fff; stroke-opacity: .85; stroke-width: 3px; stroke-linejoin: round; paint-order: stroke;
  font-size: 12.5px; font-weight: 600;
}
.plate { fill: #fff; fill-opacity: .82; }
.dark { fill: #20262b; stroke: #20262b; stroke-width: .7; }
.light { fill: #fff; stroke: #20262b; stroke-width: .7; }
.scale text, .north text { fill: #20262b; font-size: 13px; font-weight: 600; }
.north text { font-size: 11px; }
.legend {
  display: flex; flex-wrap: wrap; gap: .3rem 1.6rem; padding: .55rem 0 0 4.6rem; color: var(--soft); font-size: .88rem;
}
.legend span { display: inline-flex; align-items: center; gap: .45rem; }
.ramp i { display: inline-block; width: 11rem; height: .75rem; border-radius: 3px; border: 1px solid var(--line); }
.histograms { display: grid; grid-template-columns: repeat(auto-fit, minmax(17.5rem, 1fr)); gap: 1rem; margin: 1rem 0; }
.histogram { padding: .8rem 1rem .5rem; background: var(--card); border: 1px solid var(--line); border-radius: 10px; }
.histogram figcaption { color: var(--soft); font-size: .86rem; line-height: 1.4; min-height: 2.6em; }
.histogram b { color: var(--ink); margin-right: .4em; }
.histogram svg { display: block; width: 100%; }
.histogram rect { fill: var(--type); fill-opacity: .82; }
.axis path { stroke: var(--soft); stroke-width: 1; fill: none; }
.axis text, .median text { fill: var(--soft); font-size: 12px; }
.median path { stroke: var(--ink); stroke-width: 1; stroke-dasharray: 3 3; fill: none; }
.median text { fill: var(--ink); }
.scroll { overflow-x: auto; margin: 1rem 0; background: var(--card); border: 1px solid var(--line); border-radius: 10px; }
table { width: 100%; border-collapse: collapse; font-size: .92rem; font-variant-numeric: tabular-nums; }
caption { padding: .7rem 1rem .1rem; text-align: left; color: var(--soft); font-size: .88rem; }
th, td { padding: .42rem 1rem; text-align: right; vertical-align: top; }
thead th { border-bottom: 1px solid var(--line); font-weight: 600; white-space: nowrap; }
tbody tr + tr > * { border-top: 1px solid var(--line); }
th[scope=row], .landmarks td:nth-child(2), .landmarks th:nth-child(2), .stages th:first-child, .inputs th, .inputs td { text-align: left; }
.landmarks th[scope=row] { width: 1%; color: var(--soft); font-weight: 400; }
.stages th[scope=row] { font-weight: 500; }
.landmarks td, .stages td { white-space: nowrap; }
td small { display: block; font-size: .8rem; }
.warnings { margin: 1.4rem 0; padding: .9rem 1.2rem .9rem 2.2rem; background: var(--warn); border-left: 4px solid var(--warn-line); border-radius: 6px; }
.warnings li { white-space: pre-line; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .3rem 1.4rem; margin: 1rem 0; }
dt { color: var(--soft); } dd { margin: 0; min-width: 0; }
details { margin: 1rem 0; } summary { cursor: pointer; color: var(--accent); }
pre { padding: 1rem; background: var(--card); border: 1px solid var(--line); border-radius: 10px; white-space: pre-wrap; }
footer { margin-top: 3rem; padding-top: .9rem; border-top: 1px solid var(--line); font-size: .86rem; }
@media (max-width: 40rem) { .legend { padding-left: .6rem; } th, td { padding: .4rem .6rem; } h1 { font-size: 1.6rem; } }
@media print {
  @page { margin: 14mm; }
  :root { --paper: #fff; --card: #fff; --ink: #000; --soft: #444; --line: #ccc; --ground: #ddd; }
  body { padding: 0; font-size: 10pt; max-width: none; -webkit-print-color-adjust: exact; print-color-adjust: exact; }
  figure, .facts li, tr, .warnings { break-inside: avoid; }
  h2, h3, caption { break-after: avoid; }
  .scroll { overflow: visible; }
  .map > svg { max-height: 20cm; }
  .histograms { grid-template-columns: repeat(3, 1fr); }
  td, th { padding: .25rem .5rem; }
}
)css";

}  // namespace waymark
