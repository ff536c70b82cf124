# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Amplitudes of single orders of scripts/orders, which sets the variables used here before it loads this file.

load 'style.gp'

set lmargin at screen 0.095
set rmargin at screen 0.965
set tmargin at screen 0.80
set bmargin at screen 0.105
set border 3
set grid xtics ytics lt 1 lw 0.8 lc rgb '#cccccc'
if (is_level == 0) {
    set logscale y
}
set xrange [row_low:row_high]
set yrange [low:high]
set mxtics 2
set xlabel (over_time ? 'time / s' : speed_name . ' / rpm')
set ylabel axis_text noenhanced
set label 1 title_text at screen 0.095, screen 0.965 left font ',17' noenhanced
set label 2 method_text at screen 0.095, screen 0.93 left font ',12' textcolor rgb grey noenhanced
set key at screen 0.965, screen 0.905 right maxrows 3 samplen 2 width 2 font ',11' noenhanced

do for [format in formats] {
    eval terminal(format, 'orders_tracks', 1400, 900)
    set output picture . '.' . format
    plot 'tracks.dat' using 1:2 with lines lw 2.4 lc rgb '#bdbdbd' title overall_text, \
        for [i = 0:curves - 1] 'tracks.dat' using 1:(column(i + 3)) with lines lw 1.6 dt dash_of(i) \
            lc rgb colour_of(i) title value(sprintf('curve_%d', i))
    unset output
}
