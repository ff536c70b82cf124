# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Peak-to-peak transmission error over torque, one curve for each relief; scripts/harris sets the variables used
# here before it loads this file.

load 'style.gp'
set palette @palette_of_steps

shade(i) = curves > 1 ? 0.08 + 0.7 * i / (curves - 1.0) : 0.08 # along the palette, without its lightest end
width(i) = i == chosen ? 4.5 : 2.2
right = 0.855
set lmargin at screen 0.105
set rmargin at screen right
set tmargin at screen 0.825
set bmargin at screen 0.105
set border 3
set grid ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
set xrange [torque_low:torque_high]
set yrange [0:top]
set xlabel 'torque on the wheel / N m'
set ylabel 'peak-to-peak transmission error' . um
unset key
unset colorbox

set label title_text at screen 0.025, screen 0.96 left font ',17' noenhanced
set label 'Peak-to-peak transmission error over torque, for a family of designs' at screen 0.025, screen 0.92 left \
    font ',12' textcolor rgb grey
set label quantity at screen 0.975, screen 0.88 right font ',12' noenhanced
if (design_load >= torque_low && design_load <= torque_high) {
    set arrow from first design_load, graph 0 to first design_load, graph 1.015 nohead lw 1.4 dt (8,5) lc rgb grey
    set label design_text at first design_load, graph 1.035 center font ',12' \
        textcolor rgb grey
}
do for [i = 0:curves - 1] {
    at = value(sprintf('label_at_%d', i))
    set arrow from graph 1.004, first value(sprintf('end_%d', i)) to graph 1.022, first at nohead \
        lw width(i) / 2 lc palette frac shade(i)
    set label value(sprintf('label_%d', i)) at graph 1.03, first at left noenhanced \
        font (i == chosen ? 'DejaVu Sans Bold,12' : ',12')
}

do for [format in formats] {
    eval terminal(format, 'harris_harris', 1400, 1000)
    set output picture . '.' . format
    plot for [i = 0:curves - 1] 'curves.dat' index i using 1:2 with lines lw width(i) \
        lc palette frac shade(i)
    unset output
}
