# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The map of scripts/campbell, which sets the variables used here before it loads this file. Lines are marked
# at the rim only, so that they hide nothing.

load 'style.gp'
set palette @palette_of_steps

set lmargin at screen 0.105
set rmargin at screen 0.835
set tmargin at screen 0.855
set bmargin at screen 0.105
set xrange [0:frequency_high]
set yrange [row_low:row_high]
set cbrange [colour_low:colour_high]
set xlabel 'frequency / Hz'
set ylabel (over_time ? 'time / s' : 'pinion speed / rpm')
set cblabel 'log10 contact force amplitude / N' offset 0.6,0
set colorbox user origin screen 0.89, screen 0.105 size screen 0.022, screen 0.75
set cbtics 0.5 format '%.1f' # exponents of 10
set mxtics 2
set mytics 2
set format x '%g'
set format y '%g'
unset key

set label 1 title_text at graph 0, screen 0.96 left font ',17' noenhanced
set label 2 subtitle_text at graph 0, screen 0.925 left font ',11' textcolor '#505050' noenhanced

set label 3 sprintf('rim: order %d and its multiples', pinion_teeth) . (eigenfrequency > 0 ? \
    sprintf(', f0 = eigenfrequency %.5g Hz', eigenfrequency) : '') at screen 0.985, screen 0.025 right font ',10' \
    textcolor rgb grey

# Tooth orders: the line goes on outside where it leaves the map, at the right or at the top.
out = 1.014
do for [i = 1:words(harmonics)] {
    order = word(harmonics, i) * pinion_teeth
    leaves_rpm = 60.0 * frequency_high / order
    name = sprintf('%d', order)
    if (over_time) {
        stands_hz = order * constant_rpm / 60.0
        if (stands_hz < frequency_high) {
            set arrow from first stands_hz, graph 1 to first stands_hz, graph out nohead lw 2
            set label name at first stands_hz, graph out center offset 0,0.6 font ',13'
        }
    } else { if (leaves_rpm < row_high) {
        if (leaves_rpm > row_low) {
            set arrow from first frequency_high, first leaves_rpm \
                to graph out, first leaves_rpm * out nohead lw 2
            set label name at graph out, first leaves_rpm * out left offset 0.4,0 font ',13'
        }
    } else {
        leaves_hz = order * row_high / 60.0
        top = row_high * out
        set arrow from first leaves_hz, first row_high to first leaves_hz * out, first top nohead lw 2
        set label name at first leaves_hz * out, first top center offset 0,0.6 font ',13'
    } }
}

# Eigenfrequency: dashes above the map, and a few within it at the top and at the bottom.
if (eigenfrequency > 0 && eigenfrequency < frequency_high) {
    set arrow from first eigenfrequency, graph 1.03 to first eigenfrequency, graph 0.95 \
        nohead front lw 1.6 dt (8,5)
    set arrow from first eigenfrequency, graph 0 to first eigenfrequency, graph 0.05 \
        nohead front lw 1.6 dt (8,5)
    set label 'f0' at first eigenfrequency, graph 1.03 center offset 0,0.6 font ',13'
}

do for [format in formats] {
    eval terminal(format, 'campbell_map', 1400, 1000)
    set output picture . '.' . format
    plot 'map.bin' binary array=(columns, rows) format='%float32' endian=little \
        origin=(0, row_first) dx=frequency_step dy=row_step with image
    unset output
}
