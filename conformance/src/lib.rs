//! Distances between babybench and MuJoCo 3.3.0.
