! heat_fortran OUTPUT_DIR EDGE STEPS: the program of heat.c in Fortran.
program heat
  use mpi
  use weir_mpi
  implicit none

  real(c_float), allocatable, target :: field(:, :, :), next(:, :, :)
  character(len=1024) :: argument, directory
  integer :: edge, steps, step, rank, processes, threads, first, layers, below, above, x, y, z, ierror

  call MPI_Init_thread(MPI_THREAD_SERIALIZED, threads, ierror)
  call MPI_Comm_rank(MPI_COMM_WORLD, rank, ierror)
  call MPI_Comm_size(MPI_COMM_WORLD, processes, ierror)
  if (command_argument_count() /= 3) call stop_all('OUTPUT_DIR EDGE STEPS')
  call get_command_argument(1, directory)
  call get_command_argument(2, argument)
  read (argument, *) edge
  call get_command_argument(3, argument)
  read (argument, *) steps
  if (edge < max(3, processes)) call stop_all('EDGE must be at least 3 and the number of processes')

  first = edge * rank / processes ! counted from 0; its borders need not be those of blocks
  layers = edge * (rank + 1) / processes - first
  below = merge(rank - 1, MPI_PROC_NULL, rank > 0)
  above = merge(rank + 1, MPI_PROC_NULL, rank + 1 < processes)

  ! The layers 0 and layers + 1 are those of the neighbours.
  allocate (field(edge, edge, 0:layers + 1), next(edge, edge, 0:layers + 1))
  field = 0
  next = 0
  do z = 1, layers ! a hot ball
    do y = 1, edge
      do x = 1, edge
        if (4 * sum((2 * [x - 1, y - 1, first + z - 1] - edge)**2) < edge**2) field(x, y, z) = 1
      end do
    end do
  end do

  do step = 0, steps
    if (mod(step, 20) == 0) call save_step()
    call exchange()
    call spread_heat()
    field = next
  end do
  call MPI_Finalize(ierror)

contains

  ! The layers of this process, into DIR/heat_STEP.nvdb.
  subroutine save_step()
    type(weir_volume) :: volume
    type(weir_convert_options) :: options
    type(weir_error) :: error
    type(c_ptr) :: push
    character(len=1100) :: output
    integer(c_int64_t) :: lo(3), extent(3)

    write (output, '(a, a, i4.4, a)') trim(directory), '/heat_', step, '.nvdb'
    call check(weir_volume_init(volume, c_sizeof(volume)), error)
    volume%extent = edge
    volume%scalar_type = weir_float32
    call check(weir_convert_options_init(options, c_sizeof(options)), error)
    call check(weir_mpi_push_begin_fortran(MPI_COMM_WORLD, volume, options, trim(output) // c_null_char, push, error), &
               error)
    lo = [0, 0, first]
    extent = [edge, edge, layers]
    call check(weir_mpi_push_box(push, lo, extent, c_loc(field(1, 1, 1)), c_null_ptr, error), error)
    call check(weir_mpi_push_end(push, error), error)
    call weir_mpi_push_free(push)
  end subroutine

  subroutine exchange()
    integer :: ignored(MPI_STATUS_SIZE)

    call MPI_Sendrecv(field(1, 1, layers), edge**2, MPI_REAL, above, 0, field(1, 1, 0), edge**2, MPI_REAL, below, 0, &
                      MPI_COMM_WORLD, ignored, ierror)
    call MPI_Sendrecv(field(1, 1, 1), edge**2, MPI_REAL, below, 1, field(1, 1, layers + 1), edge**2, MPI_REAL, &
                      above, 1, MPI_COMM_WORLD, ignored, ierror)
  end subroutine

  subroutine spread_heat()
    real(c_float) :: around

    do z = 1, layers
      if (first + z == 1 .or. first + z == edge) cycle ! cold walls
      do y = 2, edge - 1
        do x = 2, edge - 1
          around = field(x - 1, y, z) + field(x + 1, y, z) + field(x, y - 1, z) + field(x, y + 1, z) + &
                   field(x, y, z - 1) + field(x, y, z + 1)
          next(x, y, z) = field(x, y, z) + 0.125 * (around - 6 * field(x, y, z))
        end do
      end do
    end do
  end subroutine

  subroutine check(status, error)
    integer(c_int32_t), intent(in) :: status
    type(weir_error), intent(in) :: error

    if (status == weir_ok) return
    call stop_all(weir_message(error))
  end subroutine

  subroutine stop_all(line)
    character(len=*), intent(in) :: line

    write (*, '(a)') 'heat_fortran: ' // line
    call MPI_Abort(MPI_COMM_WORLD, 2, ierror)
  end subroutine
end program
