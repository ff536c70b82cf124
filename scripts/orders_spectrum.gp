# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Order spectrum of scripts/orders, which sets the variables used here before it loads this file.

load 'style.gp'

set lmargin at screen 0.095
set rmargin at screen 0.965
set tmargin at screen 0.78
set bmargin at screen 0.115
set border 3
set grid ytics lt 1 lw 0.8 lc rgb '#cccccc'
if (is_level == 0) {
    set logscale y
}
set xrange [0:edge]
set yrange [low:high]
set mxtics 5
set xlabel 'order'
set ylabel axis_text noenhanced
set label 1 title_text at screen 0.095, screen 0.965 left font ',17' noenhanced
set label 2 'Order spectrum, mean square over the record' at screen 0.095, screen 0.93 left font ',12' textcolor rgb grey
load 'rim.gp'
unset key

do for [format in formats] {
    eval terminal(format, 'orders_spectrum', 1400, 800)
    set output picture . '.' . format
    plot 'spectrum.dat' using 1:2 with lines lw 1.2 lc rgb '#303030'
    unset output
}
