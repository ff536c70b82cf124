# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Instructions per evaluation against the size of the problem. scripts/bench sets folder.
set datafile separator ','
set border 3 lw 1.2
set tics out nomirror
set ylabel 'instructions / 1000'
set grid back lc '#dddddd'
do for [format in 'png svg'] {
    if (format eq 'png') {
        set terminal pngcairo size 1400,1000 font 'DejaVu Sans,12' fontscale 1.2
    } else {
        set terminal svg size 1120,800 font 'DejaVu Sans,12' background '#ffffff' name 'scaling'
    }
    set output folder . '/scaling.' . format
    set multiplot layout 2,2 title 'What an evaluation costs' font ',17'
    set key top left
    set yrange [0:*]
    set xlabel 'teeth of the pinion (contact ratio 2.12, overlap 1.84)'
    set xrange [0:210]
    set yrange [0:20]
    plot folder . '/teeth.csv' skip 1 using 1:($2/1e3) with linespoints lw 2 pt 7 lc '#181d47' title 'tables, sum', \
         '' skip 1 using 1:($3/1e3) with linespoints lw 2 pt 5 lc '#863180' title 'tables, derivatives', \
         '' skip 1 using 1:($4/1e3) with linespoints lw 2 pt 9 lc '#d44473' title 'ideal flanks, sum'
    set xlabel 'helix angle / degrees'
    set xrange [-1:36]
    plot folder . '/helix.csv' skip 1 using 1:($2/1e3) with linespoints lw 2 pt 7 lc '#181d47' title 'tables, sum', \
         '' skip 1 using 1:($3/1e3) with linespoints lw 2 pt 5 lc '#863180' title 'tables, derivatives', \
         '' skip 1 using 1:($4/1e3) with linespoints lw 2 pt 9 lc '#d44473' title 'ideal flanks, sum'
    set xlabel 'nodes of the tables in each direction'
    set xrange [0:105]
    set yrange [0:*]
    plot folder . '/nodes.csv' skip 1 using 1:($2/1e3) with linespoints lw 2 pt 7 lc '#181d47' title 'tables, sum', \
         '' skip 1 using 1:($3/1e3) with linespoints lw 2 pt 5 lc '#863180' title 'tables, derivatives'
    set xlabel 'pinion angle / rad (0 is drawn at 0.1)'
    set logscale x
    set format x '10^{%L}'
    set xrange [0.05:2e6]
    set yrange [0:20]
    plot folder . '/angle.csv' skip 1 using ($1 > 0 ? $1 : 0.1):($2/1e3) with linespoints lw 2 pt 7 lc '#181d47' \
         title 'tables, from angles, derivatives'
    unset logscale x
    set format x '%g'
    unset multiplot
    unset output
}
