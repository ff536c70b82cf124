# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Peak-to-peak transmission error over torque and relief; scripts/harris sets the variables used here before it
# loads this file.

load 'style.gp'

set lmargin at screen 0.105
set rmargin at screen 0.835
set tmargin at screen 0.825
set bmargin at screen 0.105
set xrange [torque_low:torque_high]
set yrange [number_low:number_high]
set cbrange [0:step * steps]
dx = (torque_high - torque_low) / (fine - 1.0)
dy = (number_high - number_low) / (fine - 1.0)
contours = 'contours.dat'

# Contour lines, once for both formats.
set contour base
unset surface
set cntrparam levels incremental step, step, step * steps
set table contours
splot 'map.bin' binary array=(fine, fine) format='%float32' endian=little \
    origin=(torque_low, number_low, 0) dx=dx dy=dy
unset table
unset contour
set surface
# Never without a line, of which gnuplot would complain: one outside.
set print contours append
print ''
print sprintf('%g %g 0', torque_low - 1, number_low - 1)
unset print

set palette @palette_of_steps negative
set palette maxcolors 0
set colorbox user origin screen 0.89, screen 0.105 size screen 0.022, screen 0.72
set cbtics step format '%g'
set cblabel 'peak-to-peak transmission error' . um offset 0.6,0
set xlabel 'torque on the wheel / N m'
set ylabel quantity . (unit eq '' ? '' : ' / ' . unit) noenhanced
set style textbox opaque noborder fillcolor '#ffffff' margins 0.4,0.4
unset key

set label title_text at screen 0.025, screen 0.96 left font ',17' noenhanced
set label 'Peak-to-peak transmission error, lines each ' . sprintf('%g µm; dashed: the design load', step) \
    . (has_chosen ? ', and the ' . chosen_text : '') at screen 0.025, screen 0.92 left noenhanced font ',12' \
    textcolor rgb grey
if (design_load >= torque_low && design_load <= torque_high) {
    set arrow from first design_load, graph 0 to first design_load, graph 1.015 nohead front lw 1.6 dt (8,5) \
        lc rgb '#202020'
    set label design_text at first design_load, graph 1.035 center font ',12' \
        textcolor rgb grey
}
if (has_chosen && chosen >= number_low && chosen <= number_high) {
    set arrow from graph 0, first chosen to graph 1.008, first chosen nohead front lw 1.6 dt (8,5) lc rgb '#202020'
}

do for [format in formats] {
    eval terminal(format, 'harris_map', 1400, 1000)
    set output picture . '.' . format
    plot 'map.bin' binary array=(fine, fine) format='%float32' endian=little \
            origin=(torque_low, number_low) dx=dx dy=dy with image, \
        contours using 1:2 with lines lw 1.4 lc rgb '#202020', \
        'labels.dat' using 1:2:(sprintf('%g', $3)) with labels boxed font ',10'
    unset output
}
