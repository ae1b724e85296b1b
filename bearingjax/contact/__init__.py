"""Two bodies, one contact: line contact laws, Hertz point contact, pressures."""

from .coupled import CoupledSlices as CoupledSlices
from .hertz import Ellipse as Ellipse
from .hertz import Shear as Shear
from .hertz import axis_stress as axis_stress
from .hertz import ellipse as ellipse
from .hertz import shear_below as shear_below
from .hertz import sphere_constant as sphere_constant
from .hertz import sphere_peak_pressure as sphere_peak_pressure
from .line import ISO16281 as ISO16281
from .line import AbstractLineLaw as AbstractLineLaw
from .line import LineConstant as LineConstant
from .line import Palmgren as Palmgren
from .line import half_width as half_width
from .line import peak_pressure as peak_pressure
from .line import relative_radius as relative_radius
from .line_contact import AbstractLineContact as AbstractLineContact
from .line_contact import AbstractSliceLaw as AbstractSliceLaw
from .line_contact import LineContact as LineContact
from .line_contact import response as response
from .point_law import AbstractPointLaw as AbstractPointLaw
from .point_law import FreeAngle as FreeAngle
from .point_law import OperatingAngle as OperatingAngle
from .point_law import PointConstant as PointConstant
from .point_law import ZeroAngle as ZeroAngle
from .point_law import ball_ellipses as ball_ellipses
from .point_law import balls_of as balls_of
