# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Single and cumulative pitch deviations; scripts/flanks sets the variables used here before it loads this file.

load 'flanks_style.gp'

data = 'pitch.dat'
along = pitch_is_arc ? '' : ' cos(α_t)'
set xrange [-0.7:teeth - 0.3]
set format x '%.0f'
if (teeth <= 20) { set xtics 1 }
set format y '%g'
set offsets 0, 0, graph 0.05, graph 0.05
set xzeroaxis lt 1 lw 1.0 lc rgb '#606060'
set grid ytics lt 1 lw 0.6 lc rgb '#d0d0d0'
set border 3
set key horizontal right enhanced samplen 1.5 width (pitch_is_arc ? -2 : -9) font ',11'
set style fill solid 0.85 noborder
set boxwidth 0.36

do for [format in formats] {
    eval terminal(format, 'flanks_pitch', 1400, 1000)
    set output picture . '.' . format
    set multiplot
    set lmargin at screen 0.085
    set rmargin at screen 0.975
    set tmargin at screen 0.825
    set bmargin at screen 0.525
    set label 1 title_text at screen 0.025, screen 0.96 left font ',17' noenhanced
    set label 2 sprintf('%d teeth; + material added on that flank, transverse, ', teeth) \
            . (pitch_is_arc ? 'arc at the reference circle' : 'along the line of action') \
        at screen 0.025, screen 0.92 left font ',11' textcolor rgb grey noenhanced
    set label 3 'Single pitch deviation' at screen 0.025, screen 0.865 left font ',14'
    set ylabel 'f_{pi}' . along . um
    set key at screen 0.975, screen 0.868
    set yrange [*:*]
    if (flat_single) { set yrange [-1:1] }
    plot data using ($1 - 0.19):2 with boxes lc rgb drive_colour title single_drive, \
        data using ($1 + 0.19):3 with boxes lc rgb coast_colour title single_coast

    unset label 1
    unset label 2
    set tmargin at screen 0.40
    set bmargin at screen 0.10
    set label 3 'Cumulative pitch deviation' at screen 0.025, screen 0.44
    set xlabel 'tooth'
    set ylabel 'F_{pi}' . along . um
    set key at screen 0.975, screen 0.443
    set yrange [*:*]
    if (flat_total) { set yrange [low_drive_um - 1:low_drive_um + 1] }
    plot data using 1:4 with linespoints lw 1.8 pt 7 ps 0.6 lc rgb drive_colour title total_drive, \
        data using 1:5 with linespoints lw 1.8 pt 5 ps 0.6 lc rgb coast_colour title total_coast, \
        '+' using (low_drive):(low_drive_um) every ::0::0 with points pt 6 ps 2.2 lc rgb drive_colour notitle, \
        '+' using (high_drive):(high_drive_um) every ::0::0 with points pt 6 ps 2.2 lc rgb drive_colour notitle, \
        '+' using (low_coast):(low_coast_um) every ::0::0 with points pt 6 ps 2.2 lc rgb coast_colour notitle, \
        '+' using (high_coast):(high_coast_um) every ::0::0 with points pt 6 ps 2.2 lc rgb coast_colour notitle
    unset xlabel
    unset multiplot
    unset output
}
