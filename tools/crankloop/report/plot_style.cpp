// The style sheet of all drawings, with the colours of both themes.
#include "plot.hpp"

namespace crankloop::report {

std::string_view plot_style() {
  return R"css(:root {
  --paper: #fdfdfb; --ink: #1c2126; --muted: #555d66; --rule: #d9dcdf;
  --grid: #e3e6e7; --axis: #7b838b; --zero: #59616a; --band: #f1f3f2; --accent: #00589b;
  --series-1: #00589b; --series-2: #b8480a; --series-3: #007a5c;
  --series-4: #b0407f; --series-5: #4a3c00; --series-6: #4f5a68;
  --ramp-1: #5a97c9; --ramp-2: #4085bd; --ramp-3: #2572ad; --ramp-4: #0f6099;
  --ramp-5: #0a4d7e; --ramp-6: #083c64; --ramp-7: #062a48;
}
@media screen and (prefers-color-scheme: dark) {
  :root {
    --paper: #14181b; --ink: #e4e7e9; --muted: #a5adb5; --rule: #353c42;
    --grid: #282e33; --axis: #7d868e; --zero: #99a2aa; --band: #1c2125; --accent: #5aabf0;
    --series-1: #4a9de8; --series-2: #f08040; --series-3: #5fdcb8;
    --series-4: #d77fc4; --series-5: #f5e58a; --series-6: #98a0a8;
    --ramp-1: #3f7fb5; --ramp-2: #4a90ca; --ramp-3: #5ba2dc; --ramp-4: #75b4e8;
    --ramp-5: #93c6ef; --ramp-6: #b3d8f5; --ramp-7: #d6ebfb;
  }
}
.figure { container-type: inline-size; }
.plot { display: block; width: 100%; height: auto; font-size: 16px; font-variant-numeric: tabular-nums; }
.plot text { fill: var(--muted); }
.plot .axis-title { fill: var(--ink); }
.plot .band-name { font-size: 0.8em; }
.plot .legend { fill: var(--ink); }
.plot .name {
  fill: var(--c, var(--ink)); stroke: var(--paper); stroke-width: 4px; stroke-linejoin: round;
  paint-order: stroke; font-weight: 600;
}
.plot path { fill: none; stroke-width: 1px; vector-effect: non-scaling-stroke; }
.plot .grid { stroke: var(--grid); }
.plot .fine { stroke-opacity: 0.55; }
.plot .axis { stroke: var(--axis); }
.plot .zero { stroke: var(--zero); stroke-width: 1.25px; }
.plot .band { fill: var(--band); }
.plot .curve { stroke: var(--c); stroke-width: 2px; stroke-linejoin: round; stroke-linecap: round; }
.plot .bold { stroke-width: 4px; }
.plot .dashed { stroke-dasharray: 6 5; }
.plot .curve.r1 { stroke-dasharray: 0 5; } .plot .curve.r2 { stroke-dasharray: 4 6; }
.plot .curve.r3 { stroke-dasharray: 10 6; } .plot .curve.r5 { stroke-dasharray: 14 6 0 6; }
.plot .curve.r6 { stroke-dasharray: 14 6 0 5 0 6; } .plot .curve.r7 { stroke-dasharray: 5 6 0 6; }
.plot .area { fill: var(--c); fill-opacity: 0.12; }
.plot .dot { stroke: var(--c); stroke-width: 7px; stroke-linecap: round; }
.plot .bar { fill: var(--c); }
.plot .contour { stroke-linecap: round; }
.plot .node { stroke: #000000; stroke-opacity: 0.3; stroke-width: 3px; stroke-linecap: round; }
.plot .height { stroke-width: 5px; stroke-linejoin: round; paint-order: stroke; }
.plot path.on-dark { stroke: #ffffff; } .plot path.on-light { stroke: #000000; }
.plot text.on-dark { fill: #ffffff; } .plot text.on-light { fill: #000000; }
.plot .leader { stroke: var(--muted); }
.plot .hair { stroke: var(--axis); }
.plot .key[role] { cursor: pointer; }
@media screen { .plot .off { display: none; } .plot .faint { opacity: 0.4; } }
.c1 { --c: var(--series-1); } .c2 { --c: var(--series-2); } .c3 { --c: var(--series-3); }
.c4 { --c: var(--series-4); } .c5 { --c: var(--series-5); } .c6 { --c: var(--series-6); }
.r1 { --c: var(--ramp-1); } .r2 { --c: var(--ramp-2); } .r3 { --c: var(--ramp-3); } .r4 { --c: var(--ramp-4); }
.r5 { --c: var(--ramp-5); } .r6 { --c: var(--ramp-6); } .r7 { --c: var(--ramp-7); }
@container (max-width: 450px) { .plot { font-size: 17px; } }
@container (max-width: 380px) {
  .plot { font-size: 19px; }
  .plot .curve:not(.bold) { stroke-width: 1.75px; }
  .plot .dot { stroke-width: 6px; }
}
@container (min-width: 450px) { .plot { font-size: 14px; } }
@container (min-width: 540px) { .plot { font-size: 13px; } }
@container (min-width: 640px) { .plot { font-size: 11px; } }
)css";
}

}  // namespace crankloop::report
