"""Constants of MuJoCo 3.3.0: numbers, and the names of flags."""

from __future__ import annotations

mjMINVAL = 1e-15
mjMAXVAL = 1e10
mjPI = 3.141592653589793
mjMINMU, mjMINIMP, mjMAXIMP = 1e-5, 0.0001, 0.9999
mjNREF, mjNIMP, mjNEQDATA, mjNDYN, mjNGAIN, mjNBIAS = 2, 5, 11, 10, 10, 10
mjNGROUP, mjNSOLVER, mjMAXCONPAIR = 6, 200, 50
mjMAXLIGHT, mjMAXLINE, mjMAXLINEPNT, mjMAXOVERLAY, mjMAXPLANEGRID = 100, 100, 1000, 500, 200
mjVERSION_HEADER = 330

mjDISABLESTRING = (
    *("Constraint", "Equality", "Frictionloss", "Limit", "Contact", "Passive", "Gravity", "Clampctrl", "Warmstart"),
    *("Filterparent", "Actuation", "Refsafe", "Sensor", "Midphase", "Eulerdamp", "AutoReset", "NativeCCD"),
)
mjENABLESTRING = ("Override", "Energy", "Fwdinv", "InvDiscrete", "MultiCCD", "Island")
mjTIMERSTRING = (
    *("step", "forward", "inverse", "position", "velocity", "actuation", "constraint", "advance", "pos_kinematics"),
    *("pos_inertia", "pos_collision", "pos_make", "pos_project", "col_broadphase", "col_narrowphase"),
)
mjLABELSTRING = (
    *("None", "Body", "Joint", "Geom", "Site", "Camera", "Light", "Tendon", "Actuator", "Constraint", "Flex", "Skin"),
    *("Selection", "SelPoint", "Contact", "ContactForce", "Island"),
)
mjFRAMESTRING = ("None", "Body", "Geom", "Site", "Camera", "Light", "Contact", "World")
mjVISSTRING = (
    *(("Convex Hull", "0", "H"), ("Texture", "1", "X"), ("Joint", "0", "J"), ("Camera", "0", "Q")),
    *(("Actuator", "0", "U"), ("Activation", "0", ","), ("Light", "0", "Z"), ("Tendon", "1", "V")),
    *(("Range Finder", "1", "Y"), ("Equality", "0", "E"), ("Inertia", "0", "I"), ("Scale Inertia", "0", "'")),
    *(("Perturb Force", "0", "B"), ("Perturb Object", "1", "O"), ("Contact Point", "0", "C"), ("Island", "1", "")),
    *(("Contact Force", "0", "F"), ("Contact Split", "0", "P"), ("Transparent", "0", "T"), ("Auto Connect", "0", "A")),
    *(("Center of Mass", "0", "M"), ("Select Point", "0", ""), ("Static Body", "1", "D"), ("Skin", "1", ";")),
    *(("Flex Vert", "0", ""), ("Flex Edge", "1", ""), ("Flex Face", "0", ""), ("Flex Skin", "1", "")),
    *(("Body Tree", "0", "`"), ("Flex Tree", "0", ""), ("Mesh Tree", "0", "\\"), ("SDF iters", "0", "")),
)
mjRNDSTRING = (
    *(("Shadow", "1", "S"), ("Wireframe", "0", "W"), ("Reflection", "1", "R"), ("Additive", "0", "L")),
    *(("Skybox", "1", "K"), ("Fog", "0", "G"), ("Haze", "1", "/"), ("Segment", "0", ","), ("Id Color", "0", "")),
    ("Cull Face", "1", ""),
)

__all__ = [name for name in globals() if name.startswith("mj")]
