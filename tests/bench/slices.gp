# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Error of slices against their cost, and what the exact integral costs. scripts/bench sets folder and exact.
set datafile separator ','
set border 3 lw 1.2
set tics out nomirror
set logscale xy
set format x '10^{%L}'
set format y '10^{%L}'
set xlabel 'instructions per evaluation'
set ylabel 'error of the sum / mean sum'
set title 'Slices against the exact integral' font ',17'
set xrange [1000:1e7]
set yrange [1e-5:1]
set grid back lc '#dddddd'
set key top right
set arrow 1 from exact, graph 0 to exact, graph 1 nohead lw 2 lc '#d44473'
set label 1 sprintf('exact: %.0f instructions, no error', exact) at exact*1.15, 2e-5 left textcolor '#d44473'
do for [format in 'png svg'] {
    if (format eq 'png') {
        set terminal pngcairo size 1200,840 font 'DejaVu Sans,13' fontscale 1.2
    } else {
        set terminal svg size 960,680 font 'DejaVu Sans,13' background '#ffffff' name 'slices'
    }
    set output folder . '/slices.' . format
    plot folder . '/slices.csv' skip 1 using 5:3 with linespoints lw 2 pt 7 lc '#181d47' title 'largest', \
         '' skip 1 using 5:2 with linespoints lw 2 pt 5 lc '#863180' title 'root mean square', \
         '' skip 1 using 5:2:1 with labels left offset 0.4,-0.9 font ',10' notitle
    unset output
}
