# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Transmission error over the mesh cycle at several loads; scripts/harris sets the variables used here before it
# loads this file.

load 'style.gp'

colours = "#767676 #009e73 #d55e00 #0072b2"
set lmargin at screen 0.105
set rmargin at screen 0.825
set tmargin at screen 0.845
set bmargin at screen 0.105
set border 3
set grid xtics ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
set xrange [0:cycles]
set yrange [low:high]
set xlabel 'mesh cycles of the pinion'
set ylabel (moved ? 'transmission error, loads moved together' \
    : 'transmission error (0: ideal flanks just touch)') . um
unset key

set label title_text at screen 0.025, screen 0.96 left font ',17' noenhanced
set label 'Quasi-static transmission error at several loads: ' . chosen_text at screen 0.025, screen 0.92 left \
    font ',12' textcolor rgb grey noenhanced
do for [i = 0:curves - 1] {
    at = value(sprintf('label_at_%d', i))
    set arrow from graph 1.004, first value(sprintf('end_%d', i)) to graph 1.02, first at nohead lw 1 \
        lc rgb word(colours, i + 1)
    set label value(sprintf('label_%d', i)) at graph 1.03, first at left offset 0,0.5 font ',12' \
        textcolor rgb word(colours, i + 1)
    set label value(sprintf('number_%d', i)) at graph 1.03, first at left offset 0,-0.5 font ',11' \
        textcolor rgb word(colours, i + 1)
}

do for [format in formats] {
    eval terminal(format, 'harris_te', 1400, 1000)
    set output picture . '.' . format
    plot for [i = 0:curves - 1] 'te.dat' index i using 1:2 with lines lw 2.6 lc rgb word(colours, i + 1)
    unset output
}
