# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Static curves of scripts/plot, a panel for each quantity; variables are set before this file is loaded.

load 'style.gp'

set border 3
set grid ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
set xrange [0:cycles]
set lmargin at screen 0.115
set rmargin at screen 0.83
top = 0.87
height = (top - 0.10) / panels

do for [format in formats] {
    eval terminal(format, 'plot_static', 1400, 420 + 330 * panels)
    set output picture . '.' . format
    set multiplot
    set label 1 title_text at screen 0.025, screen 0.965 left font ',17' noenhanced
    set label 2 subtitle_text at screen 0.025, screen 0.925 left font ',12' textcolor rgb grey noenhanced
    do for [panel = 0:panels - 1] {
        set format x (panel == panels - 1 ? "%g" : "")
        set tmargin at screen top - height * panel - 0.008
        set bmargin at screen top - height * (panel + 1) + 0.035
        set yrange [value(sprintf('low_%d', panel)):value(sprintf('high_%d', panel))]
        set ylabel value(sprintf('axis_%d', panel)) noenhanced
        set xlabel (panel == panels - 1 ? 'mesh cycles of the pinion' : '')
        if (panel == 0) { set key at screen 0.985, screen top - 0.01 right top samplen 1.5 font ',11' noenhanced } \
        else { unset key }
        plot for [i = 0:curves - 1] 'static.dat' index i using 1:panel + 2 with lines lw 1.8 dt dash_of(i) \
            lc rgb colour_of(i) title value(sprintf('label_%d', i))
        unset label 1
        unset label 2
    }
    unset multiplot
    unset output
}
