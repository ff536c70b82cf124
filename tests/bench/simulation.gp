# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# gearsim: error of the contact force against right-hand sides, and processor time against the length of a run.
# scripts/bench sets folder.
set datafile separator ','
set border 3 lw 1.2
set tics out nomirror
set grid back lc '#dddddd'
do for [format in 'png svg'] {
    if (format eq 'png') {
        set terminal pngcairo size 1400,600 font 'DejaVu Sans,12' fontscale 1.2
    } else {
        set terminal svg size 1120,480 font 'DejaVu Sans,12' background '#ffffff' name 'simulation'
    }
    set output folder . '/simulation.' . format
    set multiplot layout 1,2
    set title 'Error of the contact force (80 N m, deviations times 0.3)'
    set xlabel 'right-hand sides per tooth pass'
    set ylabel 'error of the force, rms'
    set logscale y
    set format y '10^{%L}'
    set xrange [0:*]
    set arrow 1 from graph 0, first 1e-3 to graph 1, first 1e-3 nohead dt (8,5) lc '#d44473' lw 2
    plot folder . '/tolerance.csv' skip 1 using 7:9 with linespoints lw 2 pt 7 lc '#181d47' title 'per vibration', \
         '' skip 1 using 7:8 with linespoints lw 2 pt 5 lc '#863180' title 'per force', \
         '' skip 1 using 7:9:1 with labels left offset 0.6,0.6 font ',10' notitle
    unset arrow 1
    unset logscale y
    set format y '%g'
    set title 'Length of the run (tables, 3000 rpm, 20 kHz)'
    set xlabel 'simulated time / s'
    set ylabel 'processor time / s'
    set yrange [0:*]
    plot folder . '/run_length.csv' skip 1 using 2:3 with linespoints lw 2 pt 7 lc '#181d47' notitle
    set yrange [*:*]
    unset multiplot
    unset output
}
