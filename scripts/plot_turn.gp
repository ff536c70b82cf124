# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Force and transmission error over one turn of the pinion; scripts/plot sets the variables.

load 'style.gp'

set border 3
set grid xtics ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
unset key
set xrange [0:teeth]

do for [format in formats] {
    eval terminal(format, 'plot_turn', 1400, 950)
    set output picture . '.' . format
    set multiplot
    set lmargin at screen 0.105
    set rmargin at screen 0.965
    set tmargin at screen 0.86
    set bmargin at screen 0.52
    set yrange [force_low:force_high]
    unset xlabel
    set ylabel 'contact force / N'
    set label 1 title_text at screen 0.025, screen 0.962 left font ',17' noenhanced
    set label 2 subtitle_text at screen 0.025, screen 0.917 left font ',12' textcolor rgb grey noenhanced
    plot 'turn.dat' using 1:2 with lines lw 1.2 lc rgb colour_of(0)

    unset label 1
    unset label 2
    set tmargin at screen 0.45
    set bmargin at screen 0.105
    set yrange [te_low:te_high]
    set xlabel 'teeth of the pinion'
    set ylabel 'dynamic transmission error' . um
    plot 'turn.dat' using 1:3 with lines lw 1.2 lc rgb colour_of(1)
    unset multiplot
    unset output
}
