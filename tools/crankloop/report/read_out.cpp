// The only script of a page: it shows a plot's values under the pointer, and hides curves when their names are clicked.
// It reads the drawing: the curves' coordinates, and the scales in data-x and data-y. Without it, and in print, the
// drawing is complete. No "<" and no "&": the page is well-formed XML.
#include "read_out.hpp"

namespace crankloop::report {

std::string_view read_out_script() {
  return R"js(
(function () {
  'use strict';
  var box = document.createElement('div');
  box.className = 'read-out';
  box.hidden = true;
  document.body.appendChild(box);
  function scale(text) {  // "low high from to [log]": user units to a value
    var n = text.split(' '), log = n[4] === 'log', f = log ? Math.log : Number;
    var low = f(+n[0]), high = f(+n[1]);
    var to = function (u) {
      var v = low + (u - n[2]) / (n[3] - n[2]) * (high - low);
      return log ? Math.exp(v) : v;
    };
    to.low = Math.min(n[2], n[3]);
    to.high = Math.max(n[2], n[3]);
    to.span = Math.abs(n[1] - n[0]);
    return to;
  }
  function say(v, to, unit) {
    if (1e-6 * to.span > Math.abs(v)) v = 0;
    return String(+v.toPrecision(4)).replace('-', '\u2212') + (unit ? '\u00a0' + unit : '');
  }
  function numbers(text) { return (text.match(/-?[\d.]+/g) || []).map(Number); }
  function pieces(path) {
    path.pieces = path.pieces || path.getAttribute('d').split('M').slice(1).map(numbers);
    return path.pieces;
  }
  function heights(series, x, y) {  // of a series at x, in user units
    var found = [];
    series.querySelectorAll('.curve').forEach(function (path) {
      pieces(path).forEach(function (p) {
        for (var i = 0; p.length - 3 > i; i += 2) {
          if ((p[i] - x) * (p[i + 2] - x) > 0) continue;
          var wide = p[i + 2] !== p[i];
          var low = Math.min(p[i + 1], p[i + 3]), high = Math.max(p[i + 1], p[i + 3]);
          found.push(wide ? p[i + 1] + (x - p[i]) / (p[i + 2] - p[i]) * (p[i + 3] - p[i + 1])
            : Math.min(high, Math.max(low, y)));
        }
      });
    });
    if (!found.length) series.querySelectorAll('.dot').forEach(function (path) {
      pieces(path).forEach(function (p) { if (5 > Math.abs(p[0] - x)) found.push(p[1]); });
    });
    series.querySelectorAll('.bar').forEach(function (bar) {
      var b = ['x', 'y', 'width', 'height'].map(function (name) { return +bar.getAttribute(name); });
      var zero = +series.getAttribute('data-zero');
      if (Math.abs(x - b[0] - b[2] / 2) > b[2] / 2 + 1) return;
      found.push(Math.abs(b[1] - zero) > Math.abs(b[1] + b[3] - zero) ? b[1] : b[1] + b[3]);
    });
    return found;
  }
  function height(field, x, y) {  // of a heat map, straight between the points of its lattice
    function list(name) { return field.getAttribute(name).split(' ').map(Number); }
    function cell(at, u) {  // which one, and how far into it
      for (var i = 0; at.length - 2 > i; ++i) if ((at[i + 1] - u) * (at[1] - at[0]) >= 0) break;
      return [i, (u - at[i]) / (at[i + 1] - at[i])];
    }
    var v = list('data-field'), ys = list('data-at-y'), i = cell(list('data-at-x'), x), j = cell(ys, y);
    var at = i[0] * ys.length + j[0], next = at + ys.length;
    return (1 - i[1]) * ((1 - j[1]) * v[at] + j[1] * v[at + 1]) + i[1] * ((1 - j[1]) * v[next] + j[1] * v[next + 1]);
  }
  function nearest(all, y, to) {
    return all.filter(function (h) { return h >= to.low - 2 ? to.high + 2 >= h : false; })
      .sort(function (a, b) { return Math.abs(a - y) - Math.abs(b - y); })[0];
  }
  function hide(svg) {
    box.hidden = true;
    if (svg.hair) svg.hair.setAttribute('d', 'M0 0');
  }
  function show(svg, event) {
    var r = svg.getBoundingClientRect(), unit = 520 / r.width;
    var x = (event.clientX - r.left) * unit, y = (event.clientY - r.top) * unit;
    var toX = scale(svg.getAttribute('data-x')), toY = scale(svg.getAttribute('data-y'));
    if (toX.low > x || x > toX.high || toY.low > y || y > toY.high) return hide(svg);
    var lines = [];
    svg.querySelectorAll('g[data-zero]').forEach(function (series) {
      var h = series.classList.contains('off') ? undefined : nearest(heights(series, x, y), y, toY);
      if (h === undefined) return;
      var name = series.getAttribute('data-name');
      lines.push((name ? name + '  ' : '') + say(toY(h), toY, svg.getAttribute('data-unit-y')));
    });
    svg.querySelectorAll('g[data-field]').forEach(function (field) {
      var v = height(field, x, y);
      if (!isFinite(v)) return;
      lines.push(svg.getAttribute('data-name-y') + '  ' + say(toY(y), toY, svg.getAttribute('data-unit-y')));
      lines.push(field.getAttribute('data-name') + '  ' + say(v, { span: 0 }, field.getAttribute('data-unit')));
    });
    if (!lines.length) return hide(svg);
    if (!svg.hair) {
      svg.hair = document.createElementNS('http://www.w3.org/2000/svg', 'path');
      svg.hair.setAttribute('class', 'hair');
      svg.appendChild(svg.hair);
    }
    svg.hair.setAttribute('d', 'M' + x + ' ' + toY.low + 'V' + toY.high);
    box.textContent = [say(toX(x), toX, svg.getAttribute('data-unit-x'))].concat(lines).join('\n');
    box.hidden = false;
    var left = event.pageX + 14;
    if (left + box.offsetWidth > document.documentElement.clientWidth) left = event.pageX - 14 - box.offsetWidth;
    box.style.left = Math.max(0, left) + 'px';
    box.style.top = event.pageY + 12 + 'px';
  }
  document.querySelectorAll('svg.plot').forEach(function (svg) {
    ['pointermove', 'pointerdown'].forEach(function (name) {
      svg.addEventListener(name, function (event) { show(svg, event); });
    });
    svg.addEventListener('pointerleave', function () { hide(svg); });
    svg.querySelectorAll('.key').forEach(function (key) {
      key.setAttribute('role', 'button');
      key.setAttribute('tabindex', '0');
      key.setAttribute('aria-pressed', 'true');
      function toggle() {
        var of = 'g[data-zero][data-s="' + key.getAttribute('data-s') + '"]';
        var off = svg.querySelector(of).classList.toggle('off');
        key.classList.toggle('faint', off);
        key.setAttribute('aria-pressed', String(!off));
      }
      key.addEventListener('click', toggle);
      key.addEventListener('keydown', function (event) {
        if (event.key !== 'Enter') { if (event.key !== ' ') return; }
        event.preventDefault();
        toggle();
      });
    });
  });
})();
)js";
}

}  // namespace crankloop::report
