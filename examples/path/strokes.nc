%
(Strokes in both axes at many speeds, 0.5 to 200 mm/s: what a diagnosis of friction, mass and play wants to see)
G21 G17 G90 G61
G1 X3 Y2 F30
X0 Y0
X6 Y5 F300
X0 Y0
X30 Y10 F3000
X0 Y20
X-30 Y-20 F6000
X40 Y10 F12000
X-40 Y30
X40 Y-30 F9000
X0 Y0
X1 Y-1 F60
X-1 Y1 F120
X0 Y0
M30
%
