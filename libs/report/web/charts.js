// SPDX-License-Identifier: BSD-3-Clause
// Draws every <figure class="chart"> of the page with chart.js, in the colours of the page.
'use strict';
(() => {
  // Okabe and Ito's colours, which people with colour-blind eyes tell apart too; black becomes ink.
  const PALETTE = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#8c6bb1',
    '#7f7f7f'];
  const SHAPES = ['circle', 'triangle', 'rect', 'rectRot', 'star', 'crossRot', 'cross', 'dash'];
  const prefersDark = matchMedia('(prefers-color-scheme: dark)');

  const styleOf = (name) =>
    getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  function axis(description, onlyIntegers) {
    const unit = description.unit ? `, ${description.unit}` : '';
    return {
      type: description.logarithmic ? 'logarithmic' : 'linear',
      title: {display: description.title !== '', text: description.title + unit,
        color: styleOf('--soft')},
      min: description.min, max: description.max,
      ticks: {color: styleOf('--soft'), maxRotation: 0, autoSkipPadding: 12,
        precision: onlyIntegers ? 0 : undefined},
      grid: {color: styleOf('--rule'), borderColor: styleOf('--soft')},
    };
  }

  function categoryAxis(stacked) {
    return {stacked, ticks: {color: styleOf('--ink'), autoSkip: false},
      grid: {display: false, borderColor: styleOf('--soft')}};
  }

  function xyDataset(series, number) {
    const color = series.dashed ? styleOf('--soft') : PALETTE[number % PALETTE.length];
    const many = series.points.length > 150;
    return {
      label: series.name,
      data: series.points.map(([x, y]) => ({x, y})),
      showLine: series.marks !== 'points',
      borderColor: color, backgroundColor: color,
      borderWidth: 2, borderDash: series.dashed ? [6, 4] : [],
      pointStyle: series.marks === 'line' ? 'line' : SHAPES[number % SHAPES.length],
      pointRadius: series.marks === 'line' ? 0 : many ? 1.5 : 4,
      pointHitRadius: 6,
    };
  }

  function barDataset(series, number) {
    return {label: series.name, data: series.values,
      backgroundColor: PALETTE[number % PALETTE.length], maxBarThickness: 34};
  }

  function configuration(chart) {
    const bars = chart.type === 'bar';
    let scales;
    if (!bars) {
      scales = {x: axis(chart.x), y: axis(chart.y)};
    } else {
      const values = {...axis(chart.values), stacked: chart.stacked};
      const names = categoryAxis(chart.stacked);
      scales = chart.horizontal ? {x: values, y: names} : {x: names, y: values};
    }
    return {
      type: bars ? 'bar' : 'scatter',
      data: {
        labels: chart.categories,
        datasets: chart.series.map(bars ? barDataset : xyDataset),
      },
      options: {
        animation: false, maintainAspectRatio: false, scales,
        indexAxis: chart.horizontal ? 'y' : 'x',
        interaction: {mode: bars ? 'index' : 'nearest', axis: chart.horizontal ? 'y' : 'x',
          intersect: false},
        plugins: {
          legend: {display: chart.series.length > 1, position: 'bottom',
            labels: {color: styleOf('--ink'), usePointStyle: !bars, boxWidth: bars ? 14 : 10}},
        },
      },
    };
  }

  const drawn = [];
  function drawAll() {
    while (drawn.length > 0) drawn.pop().destroy();
    for (const figure of document.querySelectorAll('figure.chart')) {
      const chart = JSON.parse(figure.querySelector('script').textContent);
      drawn.push(new Chart(figure.querySelector('canvas'), configuration(chart)));
    }
  }

  drawAll();
  prefersDark.addEventListener('change', drawAll);
  // Paper is narrower than the screen, and white.
  addEventListener('beforeprint', drawAll);
  addEventListener('afterprint', drawAll);
})();
