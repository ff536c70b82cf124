# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Order cuts and order spectrum of scripts/campbell, which sets the variables used here before it loads this
# file. Colours are told apart with any colour vision (blue, orange, green, purple).

load 'style.gp'

array colours[4] = ['#0072b2', '#d55e00', '#009e73', '#aa4499']
highest = word(harmonics, words(harmonics)) * pinion_teeth + 15

do for [format in formats] {
    eval terminal(format, 'campbell_orders', 1400, 1100)
    set output picture . '.' . format
    set multiplot
    set border 3
    set grid xtics ytics lt 1 lw 0.8 lc rgb '#cccccc'
    set lmargin at screen 0.095
    set rmargin at screen 0.965
    set logscale y
    set format x '%g'
    set format y '%g'
    set ylabel 'contact force amplitude / N'

    set tmargin at screen 0.865
    set bmargin at screen 0.56
    set label 1 title_text at screen 0.095, screen 0.965 left font ',17' noenhanced
    set label 2 cut_text at screen 0.095, screen 0.93 \
        left font ',12' noenhanced
    set xlabel (over_time ? 'time / s' : 'pinion speed / rpm')
    set xrange [row_low:row_high]
    set xtics autofreq
    set mxtics 2
    set yrange [amplitude_low:amplitude_high]
    set key at graph 1, screen 0.9 right horizontal samplen 1.5 width -1 font ',12'
    plot for [i = 1:words(harmonics)] 'cuts.dat' using 1:(column(i + 1)) with lines lw 1.4 \
        lc rgb colours[i] title sprintf('order %d', word(harmonics, i) * pinion_teeth)

    unset label 1
    set key at graph 1, screen 0.447
    set tmargin at screen 0.40
    set bmargin at screen 0.095
    set label 2 'Order spectrum, mean (rms) over the ' . (over_time ? 'time' : 'speeds') at screen 0.095, screen 0.44
    set xlabel 'order of the pinion speed (ticks: tooth orders)'
    set xrange [0:highest]
    set xtics pinion_teeth
    set mxtics default
    spectrum = 'spectrum.dat'
    if (!has_spectrum) {
        set label 3 'no order spectrum of so few turns' at graph 0.5, graph 0.5 center font ',12' textcolor rgb grey
        unset key
        plot NaN
        unset label 3
    } else { if (eigenfrequency > 0) {
        plot spectrum using 1:2 with lines lw 0.8 lc rgb '#bdbdbd' title 'all speeds', \
            spectrum using 1:3 with lines lw 0.8 lc rgb '#0072b2' \
                title 'above the eigenfrequency only'
    } else {
        plot spectrum using 1:2 with lines lw 0.8 lc rgb '#bdbdbd' title 'all speeds'
    } }
    unset multiplot
    unset output
}
