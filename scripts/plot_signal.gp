# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Time signal of the force and phase portrait of the transmission error; scripts/plot sets the variables. Colours say
# which flanks touch: blue those that drive the wheel forward, orange those of coast, grey none.

load 'style.gp'

set border 3
set grid xtics ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
array flank_colours[3] = ['#909090', '#0072b2', '#d55e00']
array flank_names[3] = ['no contact', 'drive flanks', 'coast flanks']

do for [format in formats] {
    eval terminal(format, 'plot_signal', 1400, 1150)
    set output picture . '.' . format
    set multiplot
    set lmargin at screen 0.105
    set rmargin at screen 0.965
    set tmargin at screen 0.855
    set bmargin at screen 0.565
    set xrange [0:time_high]
    set yrange [force_low:force_high]
    set xlabel 'time / ms'
    set ylabel 'contact force / N'
    set label 1 title_text at screen 0.025, screen 0.968 left font ',17' noenhanced
    set label 2 subtitle_text at screen 0.025, screen 0.93 left font ',12' textcolor rgb grey noenhanced
    set label 3 share_text at screen 0.025, screen 0.90 left font ',12' textcolor rgb grey noenhanced
    unset key
    plot 'signal.dat' using 1:2 with lines lw 1 lc rgb '#b0b0b0', \
        for [i = 0:2] 'signal.dat' using 1:($5 == i ? $2 : 1/0) with points pt 7 ps 0.35 lc rgb flank_colours[i + 1]

    unset label 1
    unset label 2
    unset label 3
    set tmargin at screen 0.435
    set bmargin at screen 0.09
    set xrange [te_low:te_high]
    set yrange [rate_low:rate_high]
    set xlabel 'dynamic transmission error' . um
    set ylabel 'its rate / (mm/s)'
    set key at screen 0.965, screen 0.475 right horizontal samplen 1 font ',11'
    plot 'signal.dat' using 3:4 with lines lw 1 lc rgb '#b0b0b0' notitle, \
        for [i = 0:2] 'signal.dat' using 3:($5 == i ? $4 : 1/0) with points pt 7 ps 0.35 \
            lc rgb flank_colours[i + 1] notitle, \
        for [i = 0:2] NaN with points pt 7 ps 1.2 lc rgb flank_colours[i + 1] title flank_names[i + 1]
    unset multiplot
    unset output
}
