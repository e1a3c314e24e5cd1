# Draws an overlap while the limb slides, and its remaining area. Variables: data, output.
set terminal svg size 900,860 font "sans,13" background "white"
set output output
set multiplot
set lmargin 10
set rmargin 3
set tmargin 3
set bmargin 2
set xrange [-40:760]
set yrange [-28:28]
set ytics 20
set style fill solid 0.35 noborder
set ylabel "across, mm"
set key at graph 1, graph 1.22 horizontal
set size 1, 0.22
do for [i=1:3] {
  set label 1 (i == 1 ? "at rest" : i == 2 ? "6 mm away from the yoke" : "turned by −5 mrad about the limb's centre") at graph 0, graph 1.12 left
  set origin 0, 1.0 - 0.22 * i
  if (i == 3) {
    set bmargin 3
    set xlabel "along the mitre, mm"
    set origin 0, 0.31
    set size 1, 0.25
  }
  if (i > 1) { unset key }
  file = data."/".word("overlap_rest overlap_slid overlap_turned", i).".dat"
  plot file index 0 with filledcurves closed lc rgb "#e0c48a" title "yoke sheet", \
       file index 1 with filledcurves closed lc rgb "#9db8d9" title "limb sheet", \
       file index 2 with filledcurves closed fs solid 0.9 lc rgb "#b03a2e" title "overlap", \
       file index 0 with lines lc rgb "#8a6d2f" notitle, \
       file index 1 with lines lc rgb "#41658f" notitle
}
set bmargin 3
set label 1 "area left at the corner" at graph 0, graph 1.08 left
set origin 0, 0
set size 1, 0.31
set xrange [0:26]
set yrange [0:1.05]
set ytics 0.25
set grid lc rgb "#dddddd"
set xlabel "drawn away from the yoke, across the mitre, mm"
set ylabel "share"
set key default
set key top right
plot data."/shrinking.dat" using 1:2 with lines lw 2.5 lc rgb "#1f5fa8" title "all overlaps 10 mm", \
     data."/shrinking.dat" using 1:3 with lines lw 2.5 lc rgb "#c0392b" title "book of 5 steps, 10 mm in the mean"
unset multiplot
