# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Panels below each other over the same quantity; scripts/cases sets the variables used here before it loads this file.

load 'style.gp'

colours = "#0072b2 #d55e00 #009e73 #767676"
px = 1.0 / pixels # of the png, as a share of its height
top = 1 - 150 * px
bottom = 110 * px
height = (top - bottom) / panels
set lmargin at screen 0.105
set rmargin at screen 0.965
set border 3
set grid xtics ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
set offsets 0, 0, graph 0.06, graph 0.06
set autoscale fix
set key at graph 1, graph 1 bottom right maxrows 1 samplen 2 font ',12'

look = " lc rgb word(colours, i - first_curve + 1) title value(sprintf('label_%d', i)) noenhanced"

do for [format in formats] {
    eval terminal(format, 'cases', 1400, pixels)
    set output picture . '.' . format
    set multiplot
    do for [k = 0:panels - 1] {
        first_curve = value(sprintf('first_%d', k))
        lines_to = value(sprintf('lines_to_%d', k))
        last_curve = value(sprintf('last_%d', k))
        bounds = value(sprintf('bounds_%d', k))
        unset label
        unset arrow
        if (k == 0) {
            set label title_text at screen 0.025, screen 1 - 40 * px left font ',17' noenhanced
            set label subtitle at screen 0.025, screen 1 - 80 * px left font ',12' textcolor rgb grey noenhanced
        }
        if (bounds ne 'none') {
            do for [i = 1:words(bounds)] {
                set arrow from graph 0, first word(bounds, i) + 0 to graph 1, first word(bounds, i) + 0 nohead \
                    dt 2 lw 1 lc rgb grey
            }
        }
        set tmargin at screen top - k * height - (k > 0 ? 50 * px : 0)
        set bmargin at screen top - (k + 1) * height
        set xlabel (k == panels - 1 ? xlabel_text : '') noenhanced
        if (k == panels - 1) { set format x '%g' } else { set format x '' }
        set ylabel value(sprintf('ylabel_%d', k)) noenhanced
        lines = "for [i = first_curve:lines_to] data index i using 1:2 with lines lw 2.2 " . look
        points = lines_to == last_curve ? '' \
            : ", for [i = lines_to + 1:last_curve] data index i using 1:2 with points pt 7 ps 1 " . look
        eval 'plot ' . lines . points
    }
    unset multiplot
    unset output
}
