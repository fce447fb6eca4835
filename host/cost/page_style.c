/* page_style.c: how the page looks; see page.h. */
#include "page.h"

const char *const bp_page_style[] = {
    ":root { color-scheme: light dark; --paper: #fbfaf7; --sheet: #ffffff; --ink: #1d1f23; --soft: #5d636c;\n"
    "  --line: #dcdad3; --grid: #ebe9e3; --accent: #b4530a; --glow: #f3c98f;\n"
    "  --base: #1d1f23; --truth: #15803d; --sampler: #7c3aed; --depth: #c2410c; --precision: #1d63d8;\n"
    "  --math: #0e7490; --numerics: #be185d; --fresnel: #8a6a00; --together: #64748b; --adaptive: #c026d3; "
    "}\n",
    "@media (prefers-color-scheme: dark) { :root { --paper: #131417; --sheet: #1b1d21; --ink: #eceae4;\n"
    "  --soft: #a2a7b0; --line: #383b42; --grid: #272a2f; --accent: #ffb35c; --glow: #7a4a12;\n"
    "  --base: #f4f2ec; --truth: #4ade80; --sampler: #b794ff; --depth: #ff9057; --precision: #75aaff;\n"
    "  --math: #4fd1e0; --numerics: #ff7ab8; --fresnel: #e3c04b; --together: #9fb0c6; --adaptive: #ef8bff; } "
    "}\n",
    "* { box-sizing: border-box; }\n",
    "body { margin: 0; background: var(--paper); color: var(--ink);\n"
    "  font: 16px/1.5 system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif; }\n",
    "main { max-width: 1120px; margin: 0 auto; padding: 40px 24px 64px; }\n",
    "h1 { font-size: 40px; line-height: 1.1; letter-spacing: -0.02em; margin: 0; }\n",
    "h2 { font-size: 24px; line-height: 1.2; letter-spacing: -0.01em; margin: 0 0 4px; }\n",
    "h3 { font-size: 16px; margin: 24px 0 8px; }\n",
    "p { margin: 0 0 12px; max-width: 80ch; text-wrap: pretty; }\n",
    "section { margin-top: 52px; }\n",
    ".lead { font-size: 20px; color: var(--soft); margin: 6px 0 14px; }\n",
    ".facts { display: flex; flex-wrap: wrap; gap: 4px 24px; font-size: 14px; color: var(--soft);\n"
    "  max-width: none; margin: 0; }\n",
    ".note, figcaption, .caption { font-size: 14px; color: var(--soft); }\n",
    "code { font: 13px/1.4 ui-monospace, 'DejaVu Sans Mono', Menlo, Consolas, monospace;\n"
    "  white-space: nowrap; }\n",
    ".caption, .note { max-width: 110ch; }\n",
    ".cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(240px, 1fr)); gap: 16px;\n"
    "  margin: 16px 0 12px; }\n",
    ".card { background: var(--sheet); border: 1px solid var(--line); border-top: 4px solid var(--accent);\n"
    "  border-radius: 6px; padding: 16px 20px 18px; }\n",
    ".card p { margin: 0 0 6px; }\n",
    ".card .target { color: var(--accent); font-weight: 600; }\n",
    ".card .price { font-size: 34px; line-height: 1.2; letter-spacing: -0.02em; font-weight: 600; }\n",
    ".card .note { margin: 6px 0 0; }\n",
    ".sheet { background: var(--sheet); border: 1px solid var(--line); border-radius: 6px; padding: 16px;\n"
    "  margin: 16px 0 8px; overflow-x: auto; }\n",
    "svg { display: block; width: 100%; height: auto; min-width: 720px;\n"
    "  font: 13px system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif; }\n",
    "svg text { fill: var(--ink); }\n",
    "svg .tick, svg .axis-name, svg .quiet { fill: var(--soft); }\n",
    "svg .axis-name { font-weight: 600; }\n",
    "svg .grid { stroke: var(--grid); }\n",
    "svg .major { stroke: var(--line); }\n",
    "svg .target { stroke: var(--accent); stroke-dasharray: 5 5; opacity: 0.75; }\n",
    "svg .target-name { fill: var(--accent); }\n",
    "svg .front { fill: none; stroke: var(--glow); stroke-width: 14; stroke-linejoin: round;\n"
    "  stroke-linecap: round; }\n",
    "svg .curve { fill: none; stroke: var(--c); stroke-width: 1.6; }\n",
    "svg .dot { fill: var(--sheet); stroke: var(--c); stroke-width: 1.6; }\n",
    "svg .dot.best { fill: var(--c); }\n",
    "svg .leader { fill: none; stroke: var(--c); stroke-width: 1; opacity: 0.45; }\n",
    "svg .label { fill: var(--c); font-weight: 600; }\n",
    "svg .bar { fill: var(--c); }\n",
    "svg .bar.unsure { opacity: 0.3; }\n",
    "svg .whisker { stroke: var(--ink); stroke-width: 1.5; }\n",
    "svg .zero { stroke: var(--soft); }\n",
    "svg .band { fill: var(--grid); opacity: 0.55; }\n",
    "[class^='a-'], [class*=' a-'] { --c: var(--soft); }\n",
    ".a-base { --c: var(--base); } .a-truth { --c: var(--truth); } .a-sampler { --c: var(--sampler); }\n",
    ".a-depth { --c: var(--depth); } .a-precision { --c: var(--precision); } .a-math { --c: var(--math); }\n",
    ".a-numerics { --c: var(--numerics); } .a-fresnel { --c: var(--fresnel); }\n",
    ".a-together { --c: var(--together); }\n"
    ".a-adaptive { --c: var(--adaptive); }\n",
    ".strip { display: grid; gap: 20px 16px; margin: 16px 0 12px; }\n",
    ".three { grid-template-columns: repeat(auto-fill, minmax(280px, 1fr)); }\n",
    ".four { grid-template-columns: repeat(auto-fill, minmax(230px, 1fr)); }\n",
    "figure { margin: 0; }\n",
    "figure img { display: block; width: 100%; height: auto; image-rendering: pixelated; }\n",
    "figure img:first-child { border-radius: 4px 4px 0 0; }\n",
    "figure img + img { border-radius: 0 0 4px 4px; }\n",
    "figcaption { padding-top: 6px; line-height: 1.4; }\n",
    "figcaption b { color: var(--ink); display: block; }\n",
    ".scale { display: flex; align-items: center; gap: 10px; font-size: 14px; color: var(--soft); }\n",
    ".scale .ramp { flex: 0 1 320px; height: 14px; border-radius: 3px; }\n",
    "table { border-collapse: collapse; width: 100%; font-size: 13px; font-variant-numeric: tabular-nums; "
    "}\n",
    "th, td { text-align: right; padding: 6px 0 6px 12px; border-bottom: 1px solid var(--grid);\n"
    "  white-space: nowrap; }\n",
    "th:first-child, td:first-child { text-align: left; padding-left: 0; max-width: 230px;\n"
    "  white-space: normal; }\n",
    "th { color: var(--soft); font-weight: 600; vertical-align: bottom; border-bottom-color: var(--line);\n"
    "  line-height: 1.25; }\n",
    "td:first-child span { display: block; color: var(--soft); font-size: 12px; }\n",
    "td code { font-size: 12px; }\n",
    "td.best { color: var(--accent); font-weight: 600; }\n",
    "summary { cursor: pointer; color: var(--soft); }\n",
    "@media (max-width: 600px) { h1 { font-size: 30px; } main { padding: 24px 14px 40px; } }\n",
    "@media print { .sheet, .card { break-inside: avoid; } }\n",
    NULL};
