# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Quantiles of the levels of tooth orders over all runs; scripts/sweep sets the variables used here before it loads this
# file.

load 'style.gp'

set lmargin at screen 0.115
set rmargin at screen 0.97
set tmargin at screen 0.83
set bmargin at screen 0.12
set border 3
set grid ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
set xrange [0.4:*]
set xtics 1
set yrange [0:*]
set xlabel 'harmonic of the mesh'
set ylabel quantity
set boxwidth 0.45
set style fill solid 0.45 border -1
unset key
set label title_text at screen 0.025, screen 0.955 left font ',17' noenhanced
set label sprintf('%d runs: box from 25 to 75 %%, line at 50 %%, whiskers from 5 to 95 %%', runs) \
    at screen 0.025, screen 0.905 left font ',12' textcolor rgb grey

stats 'quantiles.dat' using 1 nooutput
set xrange [0.4:STATS_max + 0.6]
do for [format in formats] {
    eval terminal(format, 'sweep_quantiles', 1100, 800)
    set output picture . '.' . format
    plot 'quantiles.dat' using 1:3:2:6:5 with candlesticks lw 1.6 lc rgb pinion_colour whiskerbars 0.5, \
        '' using 1:4:4:4:4 with candlesticks lw 3 lc rgb wheel_colour
    unset output
}
