"""MuJoCo's enumerations: names and numbers of 3.3.0."""

from __future__ import annotations

import enum

__all__ = [
    "mjtBias",
    "mjtCamLight",
    "mjtCamera",
    "mjtCatBit",
    "mjtCone",
    "mjtConstraint",
    "mjtDataType",
    "mjtDisableBit",
    "mjtDyn",
    "mjtEnableBit",
    "mjtEq",
    "mjtFontScale",
    "mjtFramebuffer",
    "mjtGain",
    "mjtGeom",
    "mjtGridPos",
    "mjtIntegrator",
    "mjtJacobian",
    "mjtJoint",
    "mjtMouse",
    "mjtObj",
    "mjtRndFlag",
    "mjtSameFrame",
    "mjtSensor",
    "mjtSolver",
    "mjtStage",
    "mjtState",
    "mjtTexture",
    "mjtTrn",
    "mjtVisFlag",
    "mjtWarning",
    "mjtWrap",
]


class mjtObj(enum.IntEnum):
    """Kinds of elements."""

    mjOBJ_UNKNOWN = 0
    mjOBJ_BODY = 1
    mjOBJ_XBODY = 2
    mjOBJ_JOINT = 3
    mjOBJ_DOF = 4
    mjOBJ_GEOM = 5
    mjOBJ_SITE = 6
    mjOBJ_CAMERA = 7
    mjOBJ_LIGHT = 8
    mjOBJ_FLEX = 9
    mjOBJ_MESH = 10
    mjOBJ_SKIN = 11
    mjOBJ_HFIELD = 12
    mjOBJ_TEXTURE = 13
    mjOBJ_MATERIAL = 14
    mjOBJ_PAIR = 15
    mjOBJ_EXCLUDE = 16
    mjOBJ_EQUALITY = 17
    mjOBJ_TENDON = 18
    mjOBJ_ACTUATOR = 19
    mjOBJ_SENSOR = 20
    mjOBJ_NUMERIC = 21
    mjOBJ_TEXT = 22
    mjOBJ_TUPLE = 23
    mjOBJ_KEY = 24
    mjOBJ_PLUGIN = 25
    mjNOBJECT = 26
    mjOBJ_FRAME = 100


class mjtGeom(enum.IntEnum):
    """Shapes of geoms."""

    mjGEOM_PLANE = 0
    mjGEOM_HFIELD = 1
    mjGEOM_SPHERE = 2
    mjGEOM_CAPSULE = 3
    mjGEOM_ELLIPSOID = 4
    mjGEOM_CYLINDER = 5
    mjGEOM_BOX = 6
    mjGEOM_MESH = 7
    mjGEOM_SDF = 8
    mjNGEOMTYPES = 9
    mjGEOM_ARROW = 100
    mjGEOM_ARROW1 = 101
    mjGEOM_ARROW2 = 102
    mjGEOM_LINE = 103
    mjGEOM_LINEBOX = 104
    mjGEOM_FLEX = 105
    mjGEOM_SKIN = 106
    mjGEOM_LABEL = 107
    mjGEOM_TRIANGLE = 108
    mjGEOM_NONE = 1001


class mjtJoint(enum.IntEnum):
    """Types of joints."""

    mjJNT_FREE = 0
    mjJNT_BALL = 1
    mjJNT_SLIDE = 2
    mjJNT_HINGE = 3


class mjtState(enum.IntEnum):
    """Parts of a state, as bits."""

    mjSTATE_TIME = 1
    mjSTATE_QPOS = 2
    mjSTATE_QVEL = 4
    mjSTATE_ACT = 8
    mjSTATE_WARMSTART = 16
    mjSTATE_CTRL = 32
    mjSTATE_QFRC_APPLIED = 64
    mjSTATE_XFRC_APPLIED = 128
    mjSTATE_EQ_ACTIVE = 256
    mjSTATE_MOCAP_POS = 512
    mjSTATE_MOCAP_QUAT = 1024
    mjSTATE_USERDATA = 2048
    mjSTATE_PLUGIN = 4096
    mjNSTATE = 13
    mjSTATE_PHYSICS = 14
    mjSTATE_FULLPHYSICS = 4111
    mjSTATE_USER = 4064
    mjSTATE_INTEGRATION = 8191


class mjtDisableBit(enum.IntEnum):
    """Parts of a simulation that can be switched off, as bits."""

    mjDSBL_CONSTRAINT = 1
    mjDSBL_EQUALITY = 2
    mjDSBL_FRICTIONLOSS = 4
    mjDSBL_LIMIT = 8
    mjDSBL_CONTACT = 16
    mjDSBL_PASSIVE = 32
    mjDSBL_GRAVITY = 64
    mjDSBL_CLAMPCTRL = 128
    mjDSBL_WARMSTART = 256
    mjDSBL_FILTERPARENT = 512
    mjDSBL_ACTUATION = 1024
    mjDSBL_REFSAFE = 2048
    mjDSBL_SENSOR = 4096
    mjDSBL_MIDPHASE = 8192
    mjDSBL_EULERDAMP = 16384
    mjDSBL_AUTORESET = 32768
    mjDSBL_NATIVECCD = 65536
    mjNDISABLE = 17


class mjtEnableBit(enum.IntEnum):
    """Parts of a simulation that can be switched on, as bits."""

    mjENBL_OVERRIDE = 1
    mjENBL_ENERGY = 2
    mjENBL_FWDINV = 4
    mjENBL_INVDISCRETE = 8
    mjENBL_MULTICCD = 16
    mjENBL_ISLAND = 32
    mjNENABLE = 6


class mjtIntegrator(enum.IntEnum):
    """Methods of integration."""

    mjINT_EULER = 0
    mjINT_RK4 = 1
    mjINT_IMPLICIT = 2
    mjINT_IMPLICITFAST = 3


class mjtSolver(enum.IntEnum):
    """Solvers of constraints."""

    mjSOL_PGS = 0
    mjSOL_CG = 1
    mjSOL_NEWTON = 2


class mjtCone(enum.IntEnum):
    """Shapes of friction cones."""

    mjCONE_PYRAMIDAL = 0
    mjCONE_ELLIPTIC = 1


class mjtJacobian(enum.IntEnum):
    """Formats of the Jacobian of constraints."""

    mjJAC_DENSE = 0
    mjJAC_SPARSE = 1
    mjJAC_AUTO = 2


class mjtEq(enum.IntEnum):
    """Kinds of equality constraints."""

    mjEQ_CONNECT = 0
    mjEQ_WELD = 1
    mjEQ_JOINT = 2
    mjEQ_TENDON = 3
    mjEQ_FLEX = 4
    mjEQ_DISTANCE = 5


class mjtConstraint(enum.IntEnum):
    """Types of constraint rows."""

    mjCNSTR_EQUALITY = 0
    mjCNSTR_FRICTION_DOF = 1
    mjCNSTR_FRICTION_TENDON = 2
    mjCNSTR_LIMIT_JOINT = 3
    mjCNSTR_LIMIT_TENDON = 4
    mjCNSTR_CONTACT_FRICTIONLESS = 5
    mjCNSTR_CONTACT_PYRAMIDAL = 6
    mjCNSTR_CONTACT_ELLIPTIC = 7


class mjtSensor(enum.IntEnum):
    """Types of sensors."""

    mjSENS_TOUCH = 0
    mjSENS_ACCELEROMETER = 1
    mjSENS_VELOCIMETER = 2
    mjSENS_GYRO = 3
    mjSENS_FORCE = 4
    mjSENS_TORQUE = 5
    mjSENS_MAGNETOMETER = 6
    mjSENS_RANGEFINDER = 7
    mjSENS_CAMPROJECTION = 8
    mjSENS_JOINTPOS = 9
    mjSENS_JOINTVEL = 10
    mjSENS_TENDONPOS = 11
    mjSENS_TENDONVEL = 12
    mjSENS_ACTUATORPOS = 13
    mjSENS_ACTUATORVEL = 14
    mjSENS_ACTUATORFRC = 15
    mjSENS_JOINTACTFRC = 16
    mjSENS_BALLQUAT = 17
    mjSENS_BALLANGVEL = 18
    mjSENS_JOINTLIMITPOS = 19
    mjSENS_JOINTLIMITVEL = 20
    mjSENS_JOINTLIMITFRC = 21
    mjSENS_TENDONLIMITPOS = 22
    mjSENS_TENDONLIMITVEL = 23
    mjSENS_TENDONLIMITFRC = 24
    mjSENS_FRAMEPOS = 25
    mjSENS_FRAMEQUAT = 26
    mjSENS_FRAMEXAXIS = 27
    mjSENS_FRAMEYAXIS = 28
    mjSENS_FRAMEZAXIS = 29
    mjSENS_FRAMELINVEL = 30
    mjSENS_FRAMEANGVEL = 31
    mjSENS_FRAMELINACC = 32
    mjSENS_FRAMEANGACC = 33
    mjSENS_SUBTREECOM = 34
    mjSENS_SUBTREELINVEL = 35
    mjSENS_SUBTREEANGMOM = 36
    mjSENS_GEOMDIST = 37
    mjSENS_GEOMNORMAL = 38
    mjSENS_GEOMFROMTO = 39
    mjSENS_E_POTENTIAL = 40
    mjSENS_E_KINETIC = 41
    mjSENS_CLOCK = 42
    mjSENS_PLUGIN = 43
    mjSENS_USER = 44


class mjtDataType(enum.IntEnum):
    """Kinds of the numbers of sensors."""

    mjDATATYPE_REAL = 0
    mjDATATYPE_POSITIVE = 1
    mjDATATYPE_AXIS = 2
    mjDATATYPE_QUATERNION = 3


class mjtStage(enum.IntEnum):
    """Stages of a computation."""

    mjSTAGE_NONE = 0
    mjSTAGE_POS = 1
    mjSTAGE_VEL = 2
    mjSTAGE_ACC = 3


class mjtTrn(enum.IntEnum):
    """The targets of actuators."""

    mjTRN_JOINT = 0
    mjTRN_JOINTINPARENT = 1
    mjTRN_SLIDERCRANK = 2
    mjTRN_TENDON = 3
    mjTRN_SITE = 4
    mjTRN_BODY = 5
    mjTRN_UNDEFINED = 1000


class mjtDyn(enum.IntEnum):
    """Dynamics of actuators."""

    mjDYN_NONE = 0
    mjDYN_INTEGRATOR = 1
    mjDYN_FILTER = 2
    mjDYN_FILTEREXACT = 3
    mjDYN_MUSCLE = 4
    mjDYN_USER = 5


class mjtGain(enum.IntEnum):
    """Gains of actuators."""

    mjGAIN_FIXED = 0
    mjGAIN_AFFINE = 1
    mjGAIN_MUSCLE = 2
    mjGAIN_USER = 3


class mjtBias(enum.IntEnum):
    """Biases of actuators."""

    mjBIAS_NONE = 0
    mjBIAS_AFFINE = 1
    mjBIAS_MUSCLE = 2
    mjBIAS_USER = 3


class mjtWrap(enum.IntEnum):
    """The path elements of tendons."""

    mjWRAP_NONE = 0
    mjWRAP_JOINT = 1
    mjWRAP_PULLEY = 2
    mjWRAP_SITE = 3
    mjWRAP_SPHERE = 4
    mjWRAP_CYLINDER = 5


class mjtCamLight(enum.IntEnum):
    """Modes of cameras and lights."""

    mjCAMLIGHT_FIXED = 0
    mjCAMLIGHT_TRACK = 1
    mjCAMLIGHT_TRACKCOM = 2
    mjCAMLIGHT_TARGETBODY = 3
    mjCAMLIGHT_TARGETBODYCOM = 4


class mjtCamera(enum.IntEnum):
    """Kinds of abstract cameras."""

    mjCAMERA_FREE = 0
    mjCAMERA_TRACKING = 1
    mjCAMERA_FIXED = 2
    mjCAMERA_USER = 3


class mjtTexture(enum.IntEnum):
    """Layouts of textures."""

    mjTEXTURE_2D = 0
    mjTEXTURE_CUBE = 1
    mjTEXTURE_SKYBOX = 2


class mjtSameFrame(enum.IntEnum):
    """Equalities between frames."""

    mjSAMEFRAME_NONE = 0
    mjSAMEFRAME_BODY = 1
    mjSAMEFRAME_INERTIA = 2
    mjSAMEFRAME_BODYROT = 3
    mjSAMEFRAME_INERTIAROT = 4


class mjtRndFlag(enum.IntEnum):
    """Flags of drawing."""

    mjRND_SHADOW = 0
    mjRND_WIREFRAME = 1
    mjRND_REFLECTION = 2
    mjRND_ADDITIVE = 3
    mjRND_SKYBOX = 4
    mjRND_FOG = 5
    mjRND_HAZE = 6
    mjRND_SEGMENT = 7
    mjRND_IDCOLOR = 8
    mjRND_CULL_FACE = 9
    mjNRNDFLAG = 10


class mjtVisFlag(enum.IntEnum):
    """Flags of what a picture shows."""

    mjVIS_CONVEXHULL = 0
    mjVIS_TEXTURE = 1
    mjVIS_JOINT = 2
    mjVIS_CAMERA = 3
    mjVIS_ACTUATOR = 4
    mjVIS_ACTIVATION = 5
    mjVIS_LIGHT = 6
    mjVIS_TENDON = 7
    mjVIS_RANGEFINDER = 8
    mjVIS_CONSTRAINT = 9
    mjVIS_INERTIA = 10
    mjVIS_SCLINERTIA = 11
    mjVIS_PERTFORCE = 12
    mjVIS_PERTOBJ = 13
    mjVIS_CONTACTPOINT = 14
    mjVIS_ISLAND = 15
    mjVIS_CONTACTFORCE = 16
    mjVIS_CONTACTSPLIT = 17
    mjVIS_TRANSPARENT = 18
    mjVIS_AUTOCONNECT = 19
    mjVIS_COM = 20
    mjVIS_SELECT = 21
    mjVIS_STATIC = 22
    mjVIS_SKIN = 23
    mjVIS_FLEXVERT = 24
    mjVIS_FLEXEDGE = 25
    mjVIS_FLEXFACE = 26
    mjVIS_FLEXSKIN = 27
    mjVIS_BODYBVH = 28
    mjVIS_FLEXBVH = 29
    mjVIS_MESHBVH = 30
    mjVIS_SDFITER = 31
    mjNVISFLAG = 32


class mjtCatBit(enum.IntEnum):
    """Categories of geoms in pictures, as bits."""

    mjCAT_STATIC = 1
    mjCAT_DYNAMIC = 2
    mjCAT_DECOR = 4
    mjCAT_ALL = 7


class mjtFontScale(enum.IntEnum):
    """Sizes of letters."""

    mjFONTSCALE_50 = 50
    mjFONTSCALE_100 = 100
    mjFONTSCALE_150 = 150
    mjFONTSCALE_200 = 200
    mjFONTSCALE_250 = 250
    mjFONTSCALE_300 = 300


class mjtFramebuffer(enum.IntEnum):
    """The targets of pictures."""

    mjFB_WINDOW = 0
    mjFB_OFFSCREEN = 1


class mjtGridPos(enum.IntEnum):
    """Positions of text on pictures."""

    mjGRID_TOPLEFT = 0
    mjGRID_TOPRIGHT = 1
    mjGRID_BOTTOMLEFT = 2
    mjGRID_BOTTOMRIGHT = 3
    mjGRID_TOP = 4
    mjGRID_BOTTOM = 5
    mjGRID_LEFT = 6
    mjGRID_RIGHT = 7


class mjtMouse(enum.IntEnum):
    """The actions of a mouse."""

    mjMOUSE_NONE = 0
    mjMOUSE_ROTATE_V = 1
    mjMOUSE_ROTATE_H = 2
    mjMOUSE_MOVE_V = 3
    mjMOUSE_MOVE_H = 4
    mjMOUSE_ZOOM = 5
    mjMOUSE_SELECT = 6


class mjtWarning(enum.IntEnum):
    """Warnings."""

    mjWARN_INERTIA = 0
    mjWARN_CONTACTFULL = 1
    mjWARN_CNSTRFULL = 2
    mjWARN_VGEOMFULL = 3
    mjWARN_BADQPOS = 4
    mjWARN_BADQVEL = 5
    mjWARN_BADQACC = 6
    mjWARN_BADCTRL = 7
    mjNWARNING = 8
