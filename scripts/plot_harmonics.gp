# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Mesh harmonics of the static transmission error over the load; scripts/plot sets the variables.

load 'style.gp'

set border 3
set grid ytics lt 1 lw 0.6 lc rgb '#d8d8d8'
set lmargin at screen 0.1
set rmargin at screen 0.965
set tmargin at screen 0.80
set bmargin at screen 0.125
set yrange [0:top]
set ylabel 'transmission error' . um
set label title_text at screen 0.025, screen 0.955 left font ',17' noenhanced
set label subtitle_text at screen 0.025, screen 0.90 left font ',12' textcolor rgb grey noenhanced
set key at screen 0.965, screen 0.87 right horizontal samplen 2 font ',11'
name(i) = i == 0 ? 'peak-to-peak' : sprintf('mesh %d', i)

do for [format in formats] {
    eval terminal(format, 'plot_harmonics', 1400, 800)
    set output picture . '.' . format
    if (loads > 1) {
        set xlabel 'torque on the wheel / N m'
        set xrange [load_low:load_high]
        plot for [i = 0:harmonics] 'harmonics.dat' using 1:i + 2 with linespoints pt 7 ps 0.7 lw 1.8 dt dash_of(i) \
            lc rgb colour_of(i) title name(i)
    } else {
        set xrange [-0.6:harmonics + 0.6]
        set xlabel sprintf('under %.5g N m', load_low)
        unset key
        set xtics ('peak-to-peak' 0)
        do for [i = 1:harmonics] { set xtics add (name(i) i) }
        set style fill solid 1
        set boxwidth 0.5
        plot for [i = 0:harmonics] 'harmonics.dat' using (i):i + 2 with boxes lc rgb colour_of(i) notitle, \
            for [i = 0:harmonics] 'harmonics.dat' using (i):i + 2:(sprintf('%.3g', column(i + 2))) with labels \
                offset 0,0.7 font ',11' notitle
    }
    unset output
}
