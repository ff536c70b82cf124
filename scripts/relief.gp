# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Peak-to-peak transmission error or face load factor over torque, before and after; scripts/relief sets the variables used here before
# it loads this file.

load 'style.gp'

array colours[2] = [grey, '#0072b2']
array names[2] = ['before', 'after']
array widths[2] = [2.4, 4]
set lmargin at screen 0.105
set rmargin at screen 0.885
set tmargin at screen 0.825
set bmargin at screen 0.105
set border 3
set grid ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
set xrange [0:torque_high]
set yrange [low:top]
set xlabel 'torque on the wheel / N m'
what = !is_face ? 'peak-to-peak transmission error' : 'face load factor'
set ylabel what . (!is_face ? um : '')
unset key

set label title_text at screen 0.025, screen 0.96 left font ',17' noenhanced
set label (!is_face ? 'Peak-to-peak transmission error' : 'Largest face load factor of the mesh cycle') \
    . ' over torque' . (range_high > range_low ? '; grey: the range searched' : '') \
    . (has_band ? (range_high > range_low ? ', bands: ' : '; bars: ') . band_text : '') at screen 0.025, screen 0.92 left font ',12' textcolor rgb grey
if (range_high > range_low) {
    set object rectangle from first range_low, graph 0 to first range_high, graph 1 behind fillcolor rgb '#eeeeee' \
        fillstyle solid noborder
}
if (design_load <= torque_high) {
    set arrow from first design_load, graph 0 to first design_load, graph 1.015 nohead lw 1.4 dt (8,5) lc rgb grey
    set label design_text at first design_load, graph 1.035 center font ',12' \
        textcolor rgb grey
}
do for [i = 1:2] {
    at = value(sprintf('label_at_%d', i - 1))
    set arrow from graph 1.004, first value(sprintf('end_%d', i - 1)) to graph 1.018, first at nohead \
        lw 1.5 lc rgb colours[i]
    set label names[i] at graph 1.025, first at left font ',13' textcolor rgb colours[i]
}

do for [format in formats] {
    eval terminal(format, 'relief', 1400, 1000)
    set output picture . '.' . format
    plot for [i = 1:2 * has_band] curves index i + 1 using 1:2:3 with filledcurves \
            fs transparent solid 0.22 noborder lc rgb colours[i], \
        for [i = 1:2 * (has_band && range_low == range_high)] curves index i + 1 using 1:2:2:3 with yerrorbars \
            lw 4 pt 0 lc rgb colours[i], \
        for [i = 1:2] curves index i - 1 using 1:2 with lines lw widths[i] lc rgb colours[i]
    unset output
}
