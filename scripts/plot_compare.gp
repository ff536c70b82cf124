# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Tooth orders of several runs over the speed, a panel for each order; scripts/plot sets the variables.

load 'style.gp'

set border 3
set grid xtics ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
set logscale y
set xrange [speed_low:speed_high]
set mxtics 2

do for [format in formats] {
    eval terminal(format, 'plot_compare', 1400, 1100)
    set output picture . '.' . format
    set multiplot
    set label 1 title_text at screen 0.025, screen 0.968 left font ',17' noenhanced
    do for [k = 0:panels - 1] {
        column = k % 2
        row = k / 2
        set lmargin at screen 0.095 + 0.475 * column
        set rmargin at screen 0.485 + 0.475 * column
        set tmargin at screen 0.82 - 0.42 * row
        set bmargin at screen 0.50 - 0.415 * row
        set yrange [value(sprintf('low_%d', k)):value(sprintf('high_%d', k))]
        set xlabel (row == 1 ? 'pinion speed / rpm' : '')
        set ylabel (column == 0 ? 'force, peak / N' : '')
        set label 2 value(sprintf('panel_%d', k)) at graph 0.02, graph 1.045 left font ',12'
        if (k == 0) { set key at screen 0.965, screen 0.93 right maxrows 3 samplen 2 width 2 font ',11' noenhanced } \
        else { unset key }
        plot for [i = 0:curves - 1] sprintf('run_%d.dat', i) using 1:k + 2 with lines lw 1.6 dt dash_of(i) \
            lc rgb colour_of(i) title value(sprintf('label_%d', i))
        unset label 1
    }
    unset multiplot
    unset output
}
