# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Lines by name above a picture over the order: names of tooth orders and of what is asked for, short ticks for turns and
# sidebands of each gear. lines.py sets the variables used here: rim_lines, rim_at_N, rim_text_N, rim_level_N, and the
# orders of the ticks.

# A name covers the line to a name above it that passes behind.
set style textbox opaque margins 0.4, 0.2 fillcolor rgb '#ffffff' noborder
do for [i = 0:rim_lines - 1] {
    at = value(sprintf('rim_at_%d', i))
    height = 1.058 + 0.03 * value(sprintf('rim_level_%d', i))
    set arrow from first at, graph 1.003 to first at, graph height - 0.014 nohead back lw 0.8 lc rgb '#909090'
    set label value(sprintf('rim_text_%d', i)) at first at, graph height center font ',10' noenhanced boxed front
}
do for [order in pinion_orders] {
    set arrow from first order, graph 1.004 to first order, graph 1.014 nohead lw 1.4 lc rgb pinion_colour
}
do for [order in wheel_orders] {
    set arrow from first order, graph 1.016 to first order, graph 1.026 nohead lw 1.4 lc rgb wheel_colour
}
do for [order in hunting_orders] {
    set arrow from first order, graph 1.028 to first order, graph 1.038 nohead lw 1.4 lc rgb hunting_colour
}
if (words(pinion_orders) > 0) {
    set label 'short ticks: turns, sidebands of' at screen 0.012, screen 0.02 left font ',10' textcolor rgb grey
    set label 'pinion' at screen 0.212, screen 0.02 left font ',10' textcolor rgb pinion_colour
    set label 'wheel' at screen 0.262, screen 0.02 left font ',10' textcolor rgb wheel_colour
    set label 'hunting tooth' at screen 0.309, screen 0.02 left font ',10' textcolor rgb hunting_colour
}
