# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Transmission error over the mesh cycle at some torques, before and after; scripts/relief sets the variables used
# here before it loads this file.

load 'style.gp'

colours = '#009e73 #d55e00 #0072b2'
names = 'before after'
set border 3
set grid xtics ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
set xrange [0:cycles]
set yrange [low:high]
set tmargin at screen 0.82
set bmargin at screen 0.115
set xlabel 'mesh cycles of the pinion'
unset key

do for [format in formats] {
    eval terminal(format, 'relief_te', 1600, 900)
    set output picture . '.' . format
    set multiplot
    do for [panel = 0:1] {
        unset label
        unset arrow
        left = 0.085 + 0.465 * panel
        set lmargin at screen left
        set rmargin at screen left + 0.355
        set label word(names, panel + 1) at screen left, screen 0.855 left font ',14'
        if (panel == 0) {
            set label title_text at screen 0.02, screen 0.955 left font ',17' noenhanced
            set label 'Quasi-static transmission error over the mesh cycle' at screen 0.02, screen 0.91 left \
                font ',12' textcolor rgb grey
            set format y '%g'
            set ylabel (moved ? 'transmission error, loads moved together' \
                : 'transmission error (0: ideal flanks just touch)') . um offset -0.3,0
        } else {
            unset ylabel
            set format y '' # as at the left
        }
        do for [i = 0:curves - 1] {
            at = value(sprintf('label_at_%d_%d', panel, i))
            set arrow from graph 1.006, first value(sprintf('end_%d_%d', panel, i)) to graph 1.025, first at nohead \
                lw 1 lc rgb word(colours, i + 1)
            set label value(sprintf('load_%d', i)) at graph 1.035, first at left offset 0,0.5 font ',11' \
                textcolor rgb word(colours, i + 1)
            set label value(sprintf('number_%d_%d', panel, i)) at graph 1.035, first at left offset 0,-0.45 font ',10' \
                textcolor rgb word(colours, i + 1)
        }
        plot for [i = 0:curves - 1] sprintf('te_%d.dat', panel) index i using 1:2 with lines lw 2.4 \
            lc rgb word(colours, i + 1)
    }
    unset multiplot
    unset output
}
